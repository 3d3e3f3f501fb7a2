# The simulation machine of the mill in tools/mill.sh: a simd that knows the mill's people by the tokens that loomlink gives them, and
# signs what it finds. Sourced by tools/demo, with $simd and $loomlink the programs, $made the folder that is being made and $scratch
# one that nobody else sees.

# Makes the machine known to the mill: it is enrolled to sign, a new trust document names it, and it knows the key of the mill's tokens.
# Dora gets a token.
set_up_box() {
    mkdir "$scratch/box"
    as mary signer invite box
    as mary signer enrol "$(answered code)" --key-file "$scratch/box/box.key"
    publish_trust
    as mary key access
    printf '{"site":"mill","access_keys":["%s"],"evidence_key":"box.key","hosts":["127.0.0.1"]}\n' "$(answered public)" > "$scratch/box/config.json"
    as dora token -o "$scratch/home/dora/token"
}

# Serves it until stop_box; a second time where it was before.
serve_box() {
    rm -f "$scratch/box/answer"
    "$simd" serve "$made/box" --config "$scratch/box/config.json" --port "${box_port:-0}" --json > "$scratch/box/answer" 2>> "$scratch/box/log" &
    box_server=$!
    local tries
    for tries in {1..600}; do
        [ ! -s "$scratch/box/answer" ] || break
        kill -0 $box_server 2> /dev/null || { cat "$scratch/box/log" >&2; return 5; }
        sleep 0.1
    done
    box_fingerprint=$(sed -nE 's/.*"certificate_sha256":"([^"]*)".*/\1/p' "$scratch/box/answer")
    box_place=$(sed -nE 's|.*"url":"https://([^"]*)".*|\1|p' "$scratch/box/answer")
    box_port=${box_place##*:}
}
stop_box() { # [SIGNAL]
    [ -n "${box_server:-}" ] || return 0
    kill "${1:--TERM}" $box_server 2> /dev/null || true
    wait $box_server 2> /dev/null || true
    box_server=
}

# Waits until the box has a checkpoint of its first job.
wait_for_checkpoint() { # PID of who waits for that job
    local tries
    for tries in {1..2400}; do
        [ ! -f "$made/box/jobs/1/checkpoint" ] || return 0
        kill -0 "$1" 2> /dev/null || break
        sleep 0.05
    done
    { cat "$scratch/answer" "$scratch/progress"; echo "== FAILED: simd has written no checkpoint of the job"; } >&2
    return 5
}

# Fails unless it was said in a file.
told_of_the_kill() { # WORDS FILE WHAT_IT_WOULD_MEAN
    grep -q "$1" "$2" && return
    { cat "$2"; echo "== FAILED: $3"; } >&2
    return 5
}

# Runs a `weave simulate` of dora's in $made while the box is killed in the middle as by a fault of the machine, and started again: the job goes
# on from its last checkpoint, and whoever waits for it notices a pause. What was said, of broken connections too, stands in $scratch/said.
simulate_and_kill() { # COMMAND...
    (cd "$made" && at_desk dora "$@") > "$scratch/answer" 2> "$scratch/progress" &
    local job=$!
    wait_for_checkpoint $job
    box_killed=$box_server
    stop_box -KILL
    serve_box
    wait $job || { cat "$scratch/progress" "$scratch/box/log" >&2; return 5; }
    told_of_the_kill 'trying again' "$scratch/progress" "who waits for the job did not notice that simd was killed" || return
    told_of_the_kill 'connected again' "$scratch/progress" "who waits for the job did not notice that simd is back" || return
    told_of_the_kill 'job 1 goes on from its checkpoint at step' "$scratch/box/log" "the job began anew" || return
    grep -E 'trying again|connected again' "$scratch/progress" > "$scratch/said"
    cat "$scratch/answer" >> "$scratch/said"
}
