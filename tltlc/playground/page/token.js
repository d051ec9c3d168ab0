// The token that the server asks for: it comes in the fragment of the address, and is kept for reloads and other tabs.

const MARK = "#token=";
const NAME = "token";
let known = "";

/** Take the token out of the address, where a copied link would give it away; whether there was one. */
export function takeToken() {
  if (!location.hash.startsWith(MARK)) return false;
  known = location.hash.slice(MARK.length);
  try {
    localStorage.setItem(NAME, known);
    history.replaceState(null, "", location.pathname);
  } catch {
    // Storage may be forbidden; then the address keeps the token until something else stands there.
  }
  return true;
}

/** The token, or nothing where there is none. */
export function token() {
  try {
    return known || (localStorage.getItem(NAME) ?? "");
  } catch {
    return known;
  }
}
