# What the mill's people see on its page: pictures by a real browser, as tests/page drives it. Sourced by tools/demo, after story.sh and mill.sh.
# Neither the browser nor what drives it is needed for the story, and nothing is installed for it: where one is missing, the page says so.

# Why there are no such pictures; empty: there are.
no_browser=
look_for_browser() {
    local program
    for program in node "${CHROMIUM:=chromium}"; do
        command -v "$program" > /dev/null || { no_browser="there is no $program here"; return; }
    done
    export CHROMIUM
    CHROMIUM=$(command -v "$CHROMIUM")
    [ -d tests/page/node_modules/playwright-core ] && [ -d tests/page/node_modules/axe-core ] || no_browser="tests/page/node_modules, which drives the browser, is missing"
}

# Once.
tell_no_browser() {
    [ -z "${told_no_browser:-}" ] || return 0
    told_no_browser=yes
    text "<em>No pictures of the mill’s page: $no_browser. <code>tools/install_deps --tests</code> installs what they take.</em>"
    say "   no pictures of the mill's page: $no_browser; tools/install_deps --tests installs what they take"
}

# Takes a picture of the page at PATH, as somebody sees it once WORDS stand there.
look() { # NAME 'FULL NAME' PATH WORDS PICTURE [OPTION of tests/page/visit.mjs...]
    [ -z "$no_browser" ] || { tell_no_browser; return; }
    local status=0
    node tests/page/visit.mjs --origin "https://localhost:$mill_port" --certificate "$made/mill/tls.pem" --password "$made/mill-password" --name "$1" --full-name "$2" \
        --page "$3" --sees "$4" --picture "$made/$5.png" "${@:6}" > "$scratch/looked" 2>&1 || status=$?
    case $status in
        0) ;;
        77) no_browser="$CHROMIUM does not start here" && tell_no_browser ;;
        *) { cat "$scratch/looked"; echo "== FAILED: $1 does not see '$4' at $3"; } >&2 && return 5 ;;
    esac
}

# Shows such a picture, where it was taken.
seen() { # PICTURE CAPTION [CLASS]
    [ ! -f "$made/$1.png" ] || figure "$1.png" "$2" "page ${3:-}"
}
