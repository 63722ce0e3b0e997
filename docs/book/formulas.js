// Indices of the formulas in the pages, which are text: `c_rs^m` is shown with its indices below and above. Without scripts, and
// where the pages are read as files, they stay as they are written.
(function () {
  "use strict";
  // One letter, varied or with a dot above or not, an index below, and one above or not; not a part of a name such as pc_solve.
  const INDEXED = /(?<![\p{L}\p{N}_])(δ?\p{L}\u0307?)_([\p{L}\p{N}]+)(?:\^(\p{L}))?(?![\p{L}\p{N}_])/gu;
  // A space within a product, where no line may end.
  const WITHIN = /(?<=[^\s=+−,]) (?=[^\s=+−,(])/g;

  function indices(below, above) {
    const pair = document.createElement("span");
    pair.className = above ? "indices both" : "indices";
    if (above) {
      pair.append(Object.assign(document.createElement("sup"), { textContent: above }));
    }
    pair.append(Object.assign(document.createElement("sub"), { textContent: below }));
    return pair;
  }

  function typeset(node) {
    const pieces = document.createDocumentFragment();
    let end = 0;
    for (const found of node.data.matchAll(INDEXED)) {
      pieces.append(node.data.slice(end, found.index), found[1], indices(found[2], found[3]));
      end = found.index + found[0].length;
    }
    if (end > 0) {
      pieces.append(node.data.slice(end));
      node.replaceWith(pieces);
    }
  }

  const pages = document.querySelector("main");
  for (const formula of pages.querySelectorAll("code.formula")) {
    formula.textContent = formula.textContent.replace(WITHIN, "\u00a0");
  }
  const walker = document.createTreeWalker(pages, NodeFilter.SHOW_TEXT);
  const texts = [];
  while (walker.nextNode()) {
    const code = walker.currentNode.parentElement.closest("code, pre");
    if (!code || code.classList.contains("formula")) {
      texts.push(walker.currentNode);
    }
  }
  texts.forEach(typeset);
})();
