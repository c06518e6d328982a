// Panels of which one is shown, by tabs that arrow keys move between.

export function addTabs(bar, pages, names, onChange) {
  const hosts = {};
  const tabs = Object.entries(names).map(([name, text]) => {
    const tab = bar.appendChild(document.createElement("button"));
    Object.assign(tab, { textContent: text, id: `tab-${name}` });
    tab.setAttribute("role", "tab");
    tab.setAttribute("aria-controls", `page-${name}`);
    const host = pages.appendChild(document.createElement("div"));
    host.id = `page-${name}`;
    host.setAttribute("role", "tabpanel");
    host.setAttribute("aria-labelledby", tab.id);
    hosts[name] = host;
    return { tab, host };
  });
  const show = (k, isFocused) => {
    tabs.forEach(({ tab, host }, i) => {
      tab.setAttribute("aria-selected", String(i === k));
      tab.tabIndex = i === k ? 0 : -1;
      host.hidden = i !== k;
    });
    if (isFocused) tabs[k].tab.focus();
    onChange();
  };
  tabs.forEach(({ tab }, k) => {
    tab.addEventListener("click", () => show(k, false));
    tab.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: k - 1, ArrowRight: k + 1, Home: 0, End: tabs.length - 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      show((to + tabs.length) % tabs.length, true);
    });
  });
  show(0, false);
  return hosts;
}
