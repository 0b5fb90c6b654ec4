#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Wraps the paragraphs and lists of all Markdown pages at 120 columns, and looks for links that lead nowhere.
#   scripts/format_docs.sh [FOLDER]           rewrites the pages below FOLDER (default: the whole source tree)
#   scripts/format_docs.sh --check [FOLDER]   names what it would change, and dead links (exit status 1: there are some)
# Left as they are: tables, code, headings, comments, and pages that a program writes (their first lines say so).
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
read_check_options "$@"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export LC_ALL=C # columns are counted in bytes, by every awk alike

list_pages() {
    find "$top" \( -name .git -o -path "$top/build" -o -path "$top/out" -o -name node_modules \) -prune -o -name '*.md' -print | sort
}

# A paragraph is collected as words and written when something else begins. A word that would begin a list or a heading
# at the start of a line stays with the word before it.
wrap_page() {
    awk -v width=120 '
        function write_paragraph(    i, line) {
            if (words == 0) return
            line = first_indent word[1]
            for (i = 2; i <= words; i++)
                if (length(line) + 1 + length(word[i]) <= width) line = line " " word[i]
                else { print line; line = indent word[i] }
            print line
            words = 0
        }
        function add_words(text,    parts, count, i) {
            count = split(text, parts, /[ \t]+/)
            for (i = 1; i <= count; i++) {
                if (parts[i] == "") continue
                if (words > 0 && parts[i] ~ /^([-+*>#|=]+|[0-9]+[.)])$/) word[words] = word[words] " " parts[i]
                else word[++words] = parts[i]
            }
        }
        function keep() { write_paragraph(); print }
        /^ *```/ { keep(); code = !code; next }
        code { print; next }
        comment { print; if (/-->/) comment = 0; next }
        /^<!--/ { keep(); comment = !/-->/; next }
        /^[ \t]*$/ { keep(); next }
        /^(#|\||---$)/ { keep(); in_list = 0; next }
        match($0, /^ *([-*]|[0-9]+[.)]) +/) && (words == 0 || in_list) {
            write_paragraph()
            first_indent = substr($0, 1, RLENGTH)
            indent = first_indent
            gsub(/[^ ]/, " ", indent)
            in_list = 1
            add_words(substr($0, RLENGTH + 1))
            next
        }
        words == 0 && !/^ / { in_list = 0 }
        words == 0 && /^    / && !in_list { print; next }
        words == 0 { match($0, /^ */); first_indent = indent = substr($0, 1, RLENGTH) }
        { add_words($0) }
        END { write_paragraph() }' "$1"
}

# The anchor that GitHub gives a heading: small letters, digits, - and _, with spaces as -.
list_anchors() {
    awk '/^```/ { code = !code }
        !code && /^#+ / {
            sub(/^#+ +/, ""); $0 = tolower($0)
            gsub(/[^a-z0-9 _-]/, ""); gsub(/ /, "-")
            print seen[$0]++ ? $0 "-" seen[$0] - 1 : $0
        }' "$1"
}

# FILE: target of each link that leads nowhere.
list_dead_links() {
    local page=$1 target path
    awk '/^```/ { code = !code } !code { gsub(/`[^`]*`/, ""); print }' "$page" | grep -oE '\]\([^) ]+\)' | sed 's/^](//; s/)$//' \
        | while read -r target; do
            [[ $target =~ ^[a-z]+: ]] && continue
            path=$page
            [[ $target == \#* ]] || path=$(dirname "$page")/${target%%#*}
            if [[ ! -e $path ]]; then
                say "${page#"$top/"}: $target: there is no such file"
            elif [[ $target == *#* ]] && ! list_anchors "$path" | grep -qxF -- "${target#*#}"; then
                say "${page#"$top/"}: $target: there is no such heading"
            fi
        done
}

problems=0
while read -r page; do
    if ! head -n 5 "$page" | grep -q '^<!-- Written by '; then
        wrap_page "$page" >"$folder/page" || die "cannot read $page"
        if cmp -s "$folder/page" "$page"; then
            :
        elif [[ $check == yes ]]; then
            say "${page#"$top/"}: not wrapped at 120 columns; run scripts/format_docs.sh"
            diff "$page" "$folder/page" | head -n 6
            problems=1
        else
            cat "$folder/page" >"$page" || die "cannot write $page"
        fi
    fi
    list_dead_links "$page" >"$folder/dead"
    [[ -s $folder/dead ]] && { cat "$folder/dead"; problems=1; }
done < <(list_pages)
exit "$problems"
