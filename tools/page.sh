# The page that tools/paper makes: pictures with the sentence that says what each shows. Sourced by it, with $weave the program,
# $made the folder that is being made, and $page the page in it.

page_head() { # TITLE COMMAND
    cat > "$page" <<PAGE
<!doctype html><html lang="en"><head><meta charset="utf-8"><title>weave: $1</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><style>
body{font:16px/1.5 "DejaVu Sans",system-ui,sans-serif;color:#222;background:#faf9f7;max-width:1200px;margin:2rem auto;padding:0 1.5rem}
h1{font-weight:600;margin-bottom:0}h2{margin-top:3rem;border-top:1px solid #ddd;padding-top:1.5rem}pre{background:#f0eee9;padding:.8rem 1rem;white-space:pre-wrap;overflow-wrap:anywhere;font-size:13px}
section{display:grid;grid-template-columns:repeat(auto-fill,minmax(340px,1fr));gap:1.2rem}figure{margin:0;background:#fff;border:1px solid #e3e0da;border-radius:6px;padding:.8rem}
img{width:100%;height:280px;object-fit:contain}figcaption{font-size:14px;color:#555;margin-top:.5rem}</style></head><body>
<h1>$1</h1><p>Made by <code>$2</code>. Click a picture to see it whole.</p>
PAGE
}

# A picture by `weave render`, which takes the options.
picture() { # FILE VIEW NAME CAPTION [OPTION...]
    "$weave" render "$made/$1" --view "$2" -o "$made/$3.png" "${@:5}" > /dev/null
    shown "$3" "$4"
}

# A picture that is there.
shown() { # NAME CAPTION
    echo "<figure><a href=\"$1.png\"><img src=\"$1.png\" alt=\"$(sed 's/<[^>]*>//g' <<< "$2")\"></a><figcaption>$2</figcaption></figure>" >> "$page"
}

# Relaxes NAME.weave into RUN.yarns and puts what was said, and what `weave inspect` tells a weaver, on the page. Yarns that did
# not come to rest are shown as well, and said so.
relax() { # NAME RUN [OPTION...]
    local verdict=0
    "$weave" simulate "$made/$1.weave" -o "$made/$2.yarns" "${@:3}" > "$made/$2.txt" 2> "$made/$2.progress" || verdict=$?
    if [ $verdict -gt 1 ]; then
        cat "$made/$2.progress" >&2
        return $verdict
    fi
    rm "$made/$2.progress"
    "$weave" inspect "$made/$2.yarns" >> "$made/$2.txt" || [ $? -eq 1 ]  # 1: it found something, and says it
    printf '<pre>weave simulate %s\n%s</pre>\n' "$1.weave ${*:3}" "$(sed "s|$made/||" "$made/$2.txt" | in_html)" >> "$page"
}

# The middle of relaxed cloth across its ends, in mm: where a section shows the warp.
middle_of() { # RUN
    sed -nE 's/.* ([0-9.]+) mm along the picks.*/\1/p' "$made/$1.txt" | awk '{ print $1 / 2; exit }'
}
