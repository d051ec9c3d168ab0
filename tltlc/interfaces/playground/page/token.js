// The token that the server requires. It comes in the fragment of the address, and is stored for reloads and other tabs.
// It is stored only after the server has accepted it, so that a link with a wrong token does not replace a right one.

const MARK = "#token=";
const NAME = "token";
/** The token from the address, until the server accepts or refuses it. */
let offered = "";
/** The last token that the server has accepted. */
let accepted = "";

/** Take a token from the address; return whether there is one. */
export function takeToken() {
  if (!location.hash.startsWith(MARK)) return false;
  offered = location.hash.slice(MARK.length);
  return true;
}

/** Return the token to send; empty if there is none. */
export function token() {
  return offered || accepted || stored();
}

/** Store a token that the server has accepted. Remove it from the address, because a copied link would reveal it. */
export function keepToken(used) {
  accepted = used;
  if (used !== offered) return;
  offered = "";
  try {
    localStorage.setItem(NAME, used);
    clearAddress(used);
  } catch {
    // Storage may be forbidden. Then the token stays in the address until the address changes.
  }
}

/** Forget a token that the server has refused; return whether there is another one to try. */
export function refuseToken(used) {
  if (used === offered) {
    offered = "";
    clearAddress(used);
  }
  if (used === accepted) accepted = "";
  return !["", used].includes(token());
}

function clearAddress(used) {
  if (location.hash === MARK + used) history.replaceState(null, "", location.pathname);
}

function stored() {
  try {
    return localStorage.getItem(NAME) ?? "";
  } catch {
    return "";
  }
}
