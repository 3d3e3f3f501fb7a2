# What the commands in this folder share: where they are, and how they talk. Sourced, not run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CCACHE_BASEDIR=$PWD

say() { echo "== $*"; }

# Runs a step; its output is shown when it fails, or as it comes where VERBOSE is set.
step() { # WHAT COMMAND...
    local what=$1 log status=0 began=$SECONDS
    shift
    say "$what"
    if [ -n "${VERBOSE:-}" ]; then
        "$@"
        return
    fi
    log=$(mktemp)
    "$@" >"$log" 2>&1 || status=$?
    if [ $status -ne 0 ]; then
        cat "$log"
        rm -f "$log"
        echo "== FAILED after $((SECONDS - began)) s: $what" >&2
        return $status
    fi
    rm -f "$log"
}

build() { # PRESET
    step "Configuring build/$1" cmake --preset "$1"
    step "Building build/$1 (the first time takes minutes)" cmake --build --preset "$1" -j "$(nproc)"
}
