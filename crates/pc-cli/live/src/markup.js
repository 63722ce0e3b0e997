// Formulas and verdicts as the server writes them.

// Puts other markup into an element; what was open stays open, and the place that is read stays.
export function put(root, html) {
  if (root.markup === html) {
    return;
  }
  root.markup = html;
  const open = new Set([...root.querySelectorAll("details[open]")].map((one) => indexOf(root, one)));
  const scroller = root.closest(".panel");
  const top = scroller?.scrollTop ?? 0;
  const template = document.createElement("template");
  template.innerHTML = html;
  root.replaceChildren(template.content);
  [...root.querySelectorAll("details")].forEach((one, i) => (one.open = open.has(i)));
  if (scroller) {
    scroller.scrollTop = top;
  }
}

function indexOf(root, one) {
  return [...root.querySelectorAll("details")].indexOf(one);
}
