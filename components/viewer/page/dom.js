// Elements of the page: made once, or changed in place.

const svg_space = 'http://www.w3.org/2000/svg';
export const byId = (id) => document.getElementById(id);

export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes))
    key in made ? made[key] = value : made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** Makes the children of `parent` those described, each a text or [name, attributes, ...children]. Nodes that are there
 *  already are changed only where they differ, so that selected text, focus and tooltips stay. */
export function patch(parent, wanted) {
  wanted.forEach((one, i) => Array.isArray(one) ? patchElement(parent, parent.childNodes[i], one) : patchText(parent, parent.childNodes[i], String(one)));
  while (parent.childNodes.length > wanted.length) parent.lastChild.remove();
}
function put(parent, old, made) { old ? old.replaceWith(made) : parent.append(made); }
function patchText(parent, old, text) {
  if (old?.nodeType !== Node.TEXT_NODE) return put(parent, old, document.createTextNode(text));
  if (old.data !== text) old.data = text;
}
function patchElement(parent, old, [name, attributes, ...children]) {
  let node = old;
  if (old?.localName !== name) {
    node = document.createElementNS(name === 'svg' ? svg_space : parent.namespaceURI, name);
    put(parent, old, node);
  }
  for (const {name: held} of [...node.attributes]) if (attributes[held] === undefined) node.removeAttribute(held);
  for (const [key, value] of Object.entries(attributes))
    if (value !== undefined && node.getAttribute(key) !== String(value)) node.setAttribute(key, value);
  patch(node, children);
}
