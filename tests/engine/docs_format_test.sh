#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What scripts/format_docs.sh changes, what it leaves alone, and that it finds links that lead nowhere.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
mkdir "$folder/docs"

twelve="one two three four five six seven eight nine ten eleven twelve" # 62 letters
cat >"$folder/docs/page.md" <<PAGE
# A heading that stays as it is, however many words it has, $twelve, $twelve
short line
$twelve $twelve
more - and 3. no list begins here [other](other.md#a-place--twice) and [here](#second)

## Second

- $twelve $twelve
  after
  1. nested $twelve $twelve
- next

| a table | $twelve $twelve |
|---|---|

    code   with    spaces $twelve $twelve

\`\`\`
code   with    spaces $twelve $twelve [no link](nowhere.md)
\`\`\`
PAGE
printf '# Other\n\n## A place & twice\n' >"$folder/docs/other.md"
cat >"$folder/expected" <<PAGE
# A heading that stays as it is, however many words it has, $twelve, $twelve
short line $twelve one two three four five six seven eight nine
ten eleven twelve more - and 3. no list begins here [other](other.md#a-place--twice) and [here](#second)

## Second

- $twelve one two three four five six seven eight nine ten eleven
  twelve after
  1. nested $twelve one two three four five six seven eight nine
     ten eleven twelve
- next

| a table | $twelve $twelve |
|---|---|

    code   with    spaces $twelve $twelve

\`\`\`
code   with    spaces $twelve $twelve [no link](nowhere.md)
\`\`\`
PAGE

printf '# Generated\n\n<!-- Written by a program -->\n\nshort\nlines\n' >"$folder/docs/generated.md"
cp "$folder/docs/generated.md" "$folder/generated"

"$root/scripts/format_docs.sh" --check "$folder" >"$folder/said" && fail "--check accepts a page that is not wrapped"
grep -q '^docs/page.md: not wrapped' "$folder/said" || fail "--check does not name the page: $(cat "$folder/said")"
"$root/scripts/format_docs.sh" "$folder" >"$folder/said" || fail "refuses good pages: $(cat "$folder/said")"
diff "$folder/expected" "$folder/docs/page.md" || fail "wraps otherwise"
cmp -s "$folder/generated" "$folder/docs/generated.md" || fail "wraps what a program has written"
"$root/scripts/format_docs.sh" --check "$folder" >"$folder/said" || fail "--check refuses what it wrote: $(cat "$folder/said")"

printf '[a](gone.md) [b](other.md#gone) [c](#gone) [d](https://example.org/gone)\n' >"$folder/docs/links.md"
"$root/scripts/format_docs.sh" --check "$folder" >"$folder/said" && fail "accepts dead links"
printf 'docs/links.md: %s\n' 'gone.md: there is no such file' 'other.md#gone: there is no such heading' \
    '#gone: there is no such heading' >"$folder/expected"
diff "$folder/expected" "$folder/said" || fail "names other links"
