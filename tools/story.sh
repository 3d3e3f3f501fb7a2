# The page of tools/demo: a story in chapters, each command as it was run, what it answered, and pictures. Sourced by it, with $made the folder
# that is being made and $page the page in it, after page.sh and mill.sh. Commands run in $made, with the programs in their PATH.

story_head() { # TITLE LEAD
    cat > "$page" <<PAGE
<!doctype html><html lang="en"><head><meta charset="utf-8"><title>weave: $1</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><style>
:root{--ink:#23262b;--soft:#6a6f78;--line:#e2ddd3;--paper:#faf8f4;--blue:#1f3a5f;--gold:#b57b12;--bad:#a3302a}
*{box-sizing:border-box}body{font:17px/1.6 "DejaVu Sans",system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:1080px;margin:0 auto;padding:3rem 1.5rem 5rem}
h1{font-size:2.1rem;line-height:1.2;font-weight:600;color:var(--blue);margin:0}h2{font-size:1.45rem;font-weight:600;color:var(--blue);margin:4rem 0 .4rem;padding-top:1.2rem;border-top:3px solid var(--gold)}
h2 b{color:var(--gold);font-weight:600;margin-right:.6rem}p{max-width:44rem;margin:.7rem 0}.lead{font-size:1.1rem;color:var(--soft)}a{color:var(--blue)}code{font-size:.9em}
pre{font:13px/1.5 "DejaVu Sans Mono",monospace;white-space:pre-wrap;overflow-wrap:anywhere;margin:0;padding:.75rem 1rem}pre:empty{display:none}
.run{margin:1.1rem 0;border:1px solid var(--line);border-radius:6px;overflow:hidden;background:#fff}.run .command{background:var(--blue);color:#fff}.run .command i{color:#f0c66b;font-style:normal}
.run.refused{border-color:var(--bad)}.run .status{color:var(--soft);padding-top:0}.run.refused .status{color:var(--bad)}details{border-top:1px solid var(--line)}summary{cursor:pointer;padding:.4rem 1rem;font-size:.85rem;color:var(--soft)}
section{display:grid;grid-template-columns:repeat(auto-fill,minmax(300px,1fr));gap:1.1rem;margin:1.4rem 0}figure{margin:0;background:#fff;border:1px solid var(--line);border-radius:6px;padding:.8rem;min-width:0}
figure.wide{grid-column:1/-1}img{display:block;width:100%;height:270px;object-fit:contain}figure.big img{height:430px}figure.page img{height:auto;border:1px solid var(--line)}figure.true img{width:auto;max-width:100%;height:auto;margin:auto}section.two{grid-template-columns:repeat(auto-fit,minmax(420px,1fr))}
figure.drawn img{image-rendering:pixelated}figcaption{font-size:.88rem;line-height:1.45;color:var(--soft);margin-top:.6rem}
table{border-collapse:collapse;font-size:.95rem;margin:1rem 0}td,th{text-align:left;padding:.3rem 1.6rem .3rem 0;border-bottom:1px solid var(--line)}td:nth-child(2){text-align:right}
@media(max-width:520px){body{padding:1.5rem 1rem}section,section.two{grid-template-columns:1fr}h1{font-size:1.6rem}}
</style></head><body><h1>$1</h1><p class="lead">$2</p>
PAGE
}

story_tail() { echo "</body></html>" >> "$page"; }

# Titles and the second in which each chapter began; `chapters_took` makes a table of them.
chapters=() began=()

chapter() { # TITLE
    chapters+=("$1") began+=("$SECONDS")
    say "${#chapters[@]}. $1"
    printf '<h2 id="c%d"><b>%d</b>%s</h2>\n' ${#chapters[@]} ${#chapters[@]} "$1" >> "$page"
}

text() { printf '<p>%s</p>\n' "$*" >> "$page"; }

pictures() { printf '<section class="%s">\n' "${1:-}" >> "$page"; }
pictures_end() { echo "</section>" >> "$page"; }

# A picture that is there already.
figure() { # FILE CAPTION [CLASS]
    printf '<figure class="%s"><a href="%s"><img src="%s" alt="%s"></a><figcaption>%s</figcaption></figure>\n' "${3:-}" "$1" "$1" "$(sed 's/<[^>]*>//g; s/"//g' <<< "$2")" "$2" >> "$page"
}

# One that `weave render` makes; nobody needs to see that command each time.
draw() { # FILE VIEW NAME CAPTION CLASS [OPTION...]
    quietly "$weave" render "$made/$1" --view "$2" -o "$made/$3.png" "${@:6}"
    figure "$3.png" "$4" "${5:-}"
}

# Runs a step that nobody needs to see; what it said is shown if it fails.
quietly() {
    "$@" > "$scratch/said" 2>&1 && return
    local status=$?
    cat "$scratch/said" >&2
    echo "== FAILED with $status: $*" >&2
    return 5
}

# A command as a person types it.
typed() {
    local word line=
    for word in "$@"; do
        [[ $word =~ ^[A-Za-z0-9_./:=,@%+-]+$ ]] || word="'${word//\'/\'\\\'\'}'"
        line+="$word "
    done
    printf '%s' "${line% }"
}

# What a command said, for the page: how far it was is left out, and what a loom's rules could not judge is folded away.
answer_in_html() { # FILE
    sed -E "/^(relaxing|planning|drawing) |^not evaluated/d; s|$made/||g" "$1" | in_html
    local folded
    folded=$(grep -c '^not evaluated' "$1") || return 0
    printf '</pre><details><summary>%d rules that could not be judged, and why</summary><pre>' "$folded"
    grep '^not evaluated' "$1" | in_html
    printf '</pre></details><pre hidden>'
}

# Runs a command from a person's own account and puts it on the page with its answer. It has to end with STATUS: a step that goes
# otherwise stops the story.
tell() { # NAME STATUS COMMAND...
    local status=0 name=$1 wanted=$2 class=
    shift 2
    (cd "$made" && at_desk "$name" "$@") > "$scratch/said" 2>&1 || status=$?
    if [ $status -ne "$wanted" ]; then
        cat "$scratch/said" >&2
        echo "== FAILED: $(typed "$@") ended with $status, not $wanted" >&2
        return 5
    fi
    put_on_page "$name" "$status" "$(typed "$@")"
}

# What stands in $scratch/said, as the answer to a command.
put_on_page() { # NAME STATUS COMMAND
    local class=run
    [ "$2" -lt 3 ] || class="run refused"
    {
        printf '<div class="%s"><pre class="command"><i>%s$</i> %s</pre><pre>' "$class" "$1" "$(in_html <<< "$3")"
        answer_in_html "$scratch/said"
        printf '</pre>'
        [ "$2" -eq 0 ] || printf '<pre class="status">exit status %d</pre>' "$2"
        echo "</div>"
    } >> "$page"
}

# How long each chapter took, and on what.
chapters_took() {
    local k end=$SECONDS
    began+=("$end")
    {
        echo "<table><tr><th>Chapter</th><th>Seconds</th></tr>"
        for k in "${!chapters[@]}"; do
            printf '<tr><td>%s</td><td>%d</td></tr>\n' "${chapters[$k]}" $((began[k + 1] - began[k]))
        done
        printf '<tr><td>All of it, after the build</td><td>%d</td></tr></table>\n' $((end - began[0]))
    } >> "$page"
    text "Measured in this run, $(date -u +%Y-%m-%d), on $(nproc) cores ($(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)), with a load of \
$(cut -d ' ' -f 1 /proc/loadavg) at the end, this run included."
}
