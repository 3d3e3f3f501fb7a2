# A mill in a folder: a site of loomlink with its first people, of whom one saves and submits a design, another approves and
# releases it, and the loom's operator pulls it and holds every byte to what was signed. Sourced by tools/demo, with $loomlink the
# program and $made the folder that is being made.

# Serves the mill until stop_mill. Answers of the program go to one file, since the next step needs parts of them.
serve_mill() {
    mill_private=$(mktemp -d)
    mill_answer=$mill_private/answer
    (umask 077 && printf 'warp and weft and warp\n' > "$made/mill-password")
    "$loomlink" serve "$made/mill" --site mill --host 127.0.0.1 --host localhost --port 0 --json > "$mill_answer" 2> "$mill_private/log" &
    mill_server=$!
    local tries
    for tries in {1..600}; do
        [ ! -s "$mill_answer" ] || break
        kill -0 $mill_server 2> /dev/null || { cat "$mill_private/log" >&2; return 5; }
        sleep 0.1
    done
    mill_fingerprint=$(answered certificate_sha256)
}
stop_mill() {
    [ -n "${mill_server:-}" ] || return 0
    kill $mill_server 2> /dev/null || true
    wait $mill_server 2> /dev/null || true
    mill_server=
    rm -rf "$mill_private"
}

answered() { sed -nE "s/.*\"$1\":\"([^\"]*)\".*/\1/p" "$mill_answer"; } # MEMBER of the last answer

# A command of one of the people, and one that this person signs with the password.
as() { # NAME COMMAND...
    "$loomlink" "${@:2}" --json --session "$mill_private/$1" > "$mill_answer"
}
signed() { # NAME COMMAND...
    as "$@" --password-file "$made/mill-password"
}
join_mill() { # NAME 'FULL NAME' LINK
    signed "$1" user join "$3" --fingerprint "$mill_fingerprint" --name "$1" --full-name "$2"
}
invite_to_mill() { # NAME 'FULL NAME' ROLE...
    as mary user invite "${@:3}"
    join_mill "$1" "$2" "$(answered link)"
}

# The mill's people, its loom `EP 1` with otto at it, and a trust document, by whose fingerprint the loom knows the mill.
set_up_mill() {
    join_mill mary 'Mary Miller' "$(answered invitation)"
    invite_to_mill dora 'Dora Draft' designer
    invite_to_mill abel 'Abel Reed' approver
    invite_to_mill otto 'Otto Shed' operator
    as mary policy --simulation optional
    as mary loom add 'EP 1' db/looms/ep-2688.json
    as mary loom operators 'EP 1' otto
    signed mary trust publish
    as mary trust show
    mill_trust=$(answered fingerprint)
}

# From a design to the folder of the loom.
release_design() { # FILE NAME
    as dora design make "$2"
    as dora save "$1" "$2" --message "As drawn"
    signed dora submit "$2" 1 --loom 'EP 1' --reason "Ready to weave"
    signed abel approve "$2" 1 --reason "Looked at, face and back"
    signed abel release "$2" 1 --loom 'EP 1' --reason "For the autumn trial"
    as otto pull 'EP 1' --to "$made/at-the-loom" --trust "$mill_trust" --state "$mill_private/state"
    "$loomlink" verify-files "$made"/at-the-loom/* --state "$mill_private/state"
}
