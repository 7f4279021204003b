#!/bin/sh
# The web page in Firefox: page_firefox_test.js. Skips (exit 77) without it. FIREFOX names the program.
# Usage: page_firefox_test.sh [FOLDER OF A PAGE THAT vpe WROTE]
here=$(cd "$(dirname "$0")" && pwd)
for name in "$FIREFOX" firefox-esr firefox; do
  [ -n "$name" ] && command -v "$name" >/dev/null 2>&1 || continue
  command -v node >/dev/null 2>&1 || { echo "skipped: no node"; exit 77; }
  FIREFOX=$(command -v "$name") exec node "$here/page_firefox_test.js" "$@"
done
echo "skipped: no firefox"
exit 77
