// Tabs, as people with and without a mouse expect them.

export class Tabs {
  constructor(list, body, changed) {
    this.body = body;
    this.tabs = [...list.querySelectorAll("[role=tab]")];
    this.changed = changed;
    list.addEventListener("click", (event) => {
      const tab = event.target.closest("[role=tab]");
      if (tab) {
        this.show(tab.dataset.tab);
      }
    });
    list.addEventListener("keydown", (event) => {
      const seen = this.tabs.filter((tab) => tab.offsetParent !== null);
      const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      const at = seen.indexOf(event.target);
      if (way && at >= 0) {
        const next = seen[(at + way + seen.length) % seen.length];
        next.focus();
        this.show(next.dataset.tab);
      }
    });
  }

  show(name) {
    this.body.dataset.tab = name;
    for (const tab of this.tabs) {
      const isShown = tab.dataset.tab === name;
      tab.setAttribute("aria-selected", String(isShown));
      tab.tabIndex = isShown ? 0 : -1;
    }
    this.changed?.(name);
  }
}
