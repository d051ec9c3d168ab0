// The token that the server asks for: it comes in the fragment of the address, and is kept for reloads and other tabs.
// It is kept only after the server has accepted it, so that a link with a wrong one takes nothing away.

const MARK = "#token=";
const NAME = "token";
/** That of the address, until the server accepts or refuses it. */
let offered = "";
/** The last one that the server has accepted. */
let accepted = "";

/** Look for a token in the address; whether there is one. */
export function takeToken() {
  if (!location.hash.startsWith(MARK)) return false;
  offered = location.hash.slice(MARK.length);
  return true;
}

/** The token to try, or nothing where there is none. */
export function token() {
  return offered || accepted || stored();
}

/** The server has accepted a token: keep it, and take it out of the address, where a copied link would give it away. */
export function keepToken(used) {
  accepted = used;
  if (used !== offered) return;
  offered = "";
  try {
    localStorage.setItem(NAME, used);
    clearAddress(used);
  } catch {
    // Storage may be forbidden; then the address keeps the token until something else stands there.
  }
}

/** The server has refused a token: forget it; whether there is another one to try. */
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
