// One colour for each series, told apart on light and on dark ground: hues of equal lightness, spread by the golden angle from the
// ninth on.

const FEW = ["#3b7dd8", "#e07b39", "#2f9e6e", "#c9486a", "#8a63d2", "#b8962e", "#1f9bb0", "#d264b6"];

export function seriesColour(k, count) {
  if (count <= FEW.length) return FEW[k];
  return `hsl(${((210 + k * 137.508) % 360).toFixed(0)}, 55%, 52%)`;
}
