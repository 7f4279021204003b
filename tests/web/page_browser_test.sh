#!/bin/sh
# The web page in a real browser: page_browser_test.js in headless Chromium. Skips (exit 77) without one.
# CHROMIUM names the program. Usage: page_browser_test.sh [FOLDER OF A PAGE THAT vpe WROTE]
here=$(cd "$(dirname "$0")" && pwd)
for name in "$CHROMIUM" chromium chromium-browser google-chrome google-chrome-stable chrome; do
  [ -n "$name" ] && command -v "$name" >/dev/null 2>&1 || continue
  command -v node >/dev/null 2>&1 || { echo "skipped: no node"; exit 77; }
  CHROMIUM=$(command -v "$name") exec node "$here/page_browser_test.js" "$@"
done
echo "skipped: no chromium"
exit 77
