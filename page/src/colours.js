// One colour for each series, told apart on light and on dark ground, and lines for readers who see few colours: dashes tell them apart.

const COLOURS = ["#3b7dd8", "#e07b39", "#2f9e6e", "#c9486a", "#8a63d2", "#9d9a16", "#0fb0b4", "#d867bb", "#8c5a3c", "#6b7684"];
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3]];

export const seriesColour = (k) => COLOURS[k % COLOURS.length];

// From the eleventh on colours come again, with other dashes; `isPatterned`: neighbours differ by dashes, too.
export const dashes = (k, isPatterned) => DASHES[(Math.floor(k / COLOURS.length) + (isPatterned ? k : 0)) % DASHES.length];
