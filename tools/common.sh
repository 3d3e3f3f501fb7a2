# What the commands in this folder share: where they are, and how they talk. Sourced, not run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CCACHE_BASEDIR=$PWD

say() { echo "== $*"; }

in_html() { sed 's/&/\&amp;/g; s/</\&lt;/g'; }

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

# All of a build, or these targets of it.
build() { # PRESET [TARGET...]
    step "Configuring build/$1" cmake --preset "$1"
    step "Building build/$1 (the first time takes minutes)" \
        cmake --build --preset "$1" -j "$(nproc)" ${2:+--target "${@:2}"}
}

# A folder that a command makes again and again lists its own files in this one.
own_list=.made-by-weave

# Ends with status 4 where FOLDER holds anything that its own list does not name: that is someone's, and stays.
own_or_stop() { # FOLDER
    [ -e "$1" ] || [ -L "$1" ] || return 0
    local stranger
    if [ -d "$1" ] && [ ! -L "$1" ]; then
        stranger=$(cd "$1" && find . -mindepth 1 ! -type d | LC_ALL=C sort |
            LC_ALL=C comm -23 - <({ echo "./$own_list"; cat "$own_list" 2>/dev/null; } | LC_ALL=C sort) | head -n 1)
        [ -n "$stranger" ] || return 0
        echo "== REFUSED: $1 holds ${stranger#./}, which was not made here; name another folder" >&2
    else
        echo "== REFUSED: $1 is not a folder; name another one" >&2
    fi
    exit 4
}

# Makes MADE the new FOLDER, in the place of the one that an earlier run left.
put_into_place() { # MADE FOLDER
    local aside
    mkdir -p "$(dirname "$2")"
    aside=$(mktemp -d "$(dirname "$2")/.weave-XXXXXX")
    cp -r "$1" "$aside/new"
    (cd "$aside/new" && find . -mindepth 1 ! -type d > "$aside/list" && mv "$aside/list" "$own_list")
    (own_or_stop "$2") || { rm -rf "$aside"; exit 4; }
    [ ! -e "$2" ] || mv "$2" "$aside/old"
    mv "$aside/new" "$2"
    rm -rf "$aside"
}
