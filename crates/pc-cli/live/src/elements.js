// Elements of the page.

// An element with properties, attributes (with a dash or `role`), listeners (`onclick`) and children.
export function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes("-") || key === "role") {
      made.setAttribute(key, value);
    } else {
      made[key] = value;
    }
  }
  made.append(...children);
  return made;
}

export const byId = (id) => document.getElementById(id);
