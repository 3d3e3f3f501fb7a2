# The simulation machine of the mill in tools/mill.sh: a simd that knows the mill's people by the tokens that loomlink gives them, and
# signs what it finds. Sourced by tools/demo, with $simd and $loomlink the programs and $made the folder that is being made.

# Makes the machine known to the mill: it is enrolled to sign, and knows the key of the mill's tokens.
set_up_box() {
    box_private=$(mktemp -d)
    as mary signer invite box
    as mary signer enrol "$(answered code)" --key-file "$box_private/box.key"
    as mary key access
    printf '{"site":"mill","access_keys":["%s"],"evidence_key":"box.key","hosts":["127.0.0.1"]}\n' "$(answered public)" > "$box_private/config.json"
    as dora token -o "$box_private/token"
}

# Serves it until stop_box; a second time where it was before.
serve_box() {
    "$simd" serve "$made/box" --config "$box_private/config.json" --port "${box_port:-0}" --json > "$box_private/answer" 2>> "$box_private/log" &
    box_server=$!
    local tries
    for tries in {1..600}; do
        [ ! -s "$box_private/answer" ] || break
        kill -0 $box_server 2> /dev/null || { cat "$box_private/log" >&2; return 5; }
        sleep 0.1
    done
    box_place=$(sed -nE 's/.*"url":"([^"]*)".*/\1/p' "$box_private/answer")
    box_fingerprint=$(sed -nE 's/.*"certificate_sha256":"([^"]*)".*/\1/p' "$box_private/answer")
    box_port=${box_place##*:}
}
stop_box() { # [SIGNAL]
    [ -n "${box_server:-}" ] || return 0
    kill "${1:--TERM}" $box_server 2> /dev/null || true
    wait $box_server 2> /dev/null || true
    box_server=
}

# Waits until the box has a checkpoint of its first job.
wait_for_checkpoint() {
    local tries
    for tries in {1..1200}; do
        [ ! -f "$made/box/jobs/1/checkpoint" ] || return 0
        sleep 0.05
    done
    echo "simd has written no checkpoint" >&2
    return 5
}

# Relaxes NAME.weave on the box as dora. In the middle of it the box is killed as by a fault of the machine, and started again: the
# job goes on from its last checkpoint, and whoever waits for it notices a pause.
relax_on_box() { # NAME [OPTION...]
    "$weave" simulate "$made/$1.weave" -o "$made/$1.yarns" --on "$box_place" --fingerprint "$box_fingerprint" \
        --token-file "$box_private/token" --evidence "$made/$1.evidence" "${@:2}" > "$made/$1.txt" 2> "$box_private/progress" &
    local job=$!
    wait_for_checkpoint
    stop_box -KILL
    serve_box
    wait $job || { cat "$box_private/progress" "$box_private/log" >&2; return 5; }
    "$weave" inspect "$made/$1.yarns" >> "$made/$1.txt" || [ $? -eq 1 ]  # 1: it found something, and says it
}

# What the box found, with its signature, is filed with the revision that dora submits.
submit_with_evidence() { # NAME
    as dora design make "$1"
    as dora save "$made/$1.weave" "$1" --message "As drawn"
    signed dora submit "$1" 1 --loom 'EP 1' --reason "Relaxed on the box" --evidence "$made/$1.evidence"
    "$loomlink" evidence list "$1" 1 --session "$mill_private/dora"
}
