// What the browser keeps: the scene and the picture as files, the link in the clipboard.

import { SHARING } from "./link.js";

export async function copyLink(state) {
  await navigator.clipboard.writeText(location.href.split(/[?#]/)[0] + state.fragment());
  return SHARING;
}

export function keep(content, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
