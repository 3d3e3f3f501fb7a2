# A mill in a folder: a site of loomlink with its first people and two looms. Sourced by tools/demo and tests/checks/release_test, with
# $loomlink the program, $made the folder that is being made and $scratch one that nobody else sees.

# Serves the mill until stop_mill. Answers of the program go to one file, since the next step needs parts of them.
serve_mill() {
    mill_answer=$scratch/mill-answer
    (umask 077 && printf 'warp and weft and warp\n' > "$made/mill-password")
    "$loomlink" serve "$made/mill" --site mill --host 127.0.0.1 --host localhost --port 0 --json > "$mill_answer" 2> "$scratch/mill-log" &
    mill_server=$!
    local tries
    for tries in {1..600}; do
        [ ! -s "$mill_answer" ] || break
        kill -0 $mill_server 2> /dev/null || { cat "$scratch/mill-log" >&2; return 5; }
        sleep 0.1
    done
    mill_fingerprint=$(answered certificate_sha256)
    mill_port=$(answered url | sed -nE 's|.*:([0-9]+)/?$|\1|p')
}
stop_mill() {
    [ -n "${mill_server:-}" ] || return 0
    kill $mill_server 2> /dev/null || true
    wait $mill_server 2> /dev/null || true
    mill_server=
}

answered() { sed -nE "s/.*\"$1\":\"([^\"]*)\".*/\1/p" "$mill_answer"; } # MEMBER of the last answer

# A command from the account of one of the people, whose home is a folder here: each has a session, and a loom a state, of their own, and
# who has a token for simd there shows it.
at_desk() ( # NAME COMMAND...
    export HOME=$scratch/home/$1
    unset XDG_CONFIG_HOME XDG_STATE_HOME WEAVE_TOKEN
    mkdir -p "$HOME"
    [ ! -f "$HOME/token" ] || { WEAVE_TOKEN=$(< "$HOME/token") && export WEAVE_TOKEN; }
    "${@:2}"
)
# A command of loomlink by one of the people, and one that this person signs with the password.
as() { # NAME COMMAND...
    at_desk "$1" "$loomlink" "${@:2}" --json > "$mill_answer"
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

# The mill's people, its looms with otto at them, and a trust document, by whose fingerprint the looms know the mill. Dora may approve
# what others draw; a release needs a simulation, as it does where nothing else is said.
set_up_mill() {
    join_mill mary 'Mary Miller' "$(answered invitation)"
    invite_to_mill dora 'Dora Draft' designer approver
    invite_to_mill abel 'Abel Reed' approver
    invite_to_mill otto 'Otto Shed' operator
    invite_to_mill edda 'Edda Proof' engineer
    as mary loom add TC2 db/looms/tc2.json
    as mary loom add 'EP 1' db/looms/ep-2688.json
    as mary loom operators TC2 otto
    as mary loom operators 'EP 1' otto
    publish_trust
}

# Whose keys count from now on, in $made/trust.json, and the fingerprint by which a loom knows it.
publish_trust() {
    signed mary trust publish
    as mary trust show -o "$made/trust.json"
    as mary trust show
    mill_trust=$(answered fingerprint)
}
