# The figures of the paper, a function each, and its Table 1: sourced by tools/paper, with tools/page.sh and what it asks for. Runs
# that do not come to rest are bounded by steps, not by seconds, so that a busy machine makes the same pictures.
paper_parts=(fig1 fig3 fig4 fig5 fig6 fig7 fig8 fig9 fig10 fig11 fig12 fig13 fig14 fig15 fig16 fig17 fig18 fig19 table1)

sample() { # NAME...: those that are not there yet
    local name
    for name in "$@"; do [ -f "$made/$name.weave" ] || "$weave" samples "$name" -o "$made/$name.weave" > /dev/null; done
}
heading() { printf '<h2>%s</h2>\n' "$1" >> "$page"; }
pictures() { echo "<section>" >> "$page"; }
done_with_pictures() { echo "</section>" >> "$page"; }

# What a command says of a file, on the page and in NAME.txt; status 1, findings, is no fault here.
told() { # NAME COMMAND [ARGUMENT...]
    local name=$1
    shift
    { (cd "$made" && "$OLDPWD/$weave" "$@") > "$made/$name.txt" 2>&1; } || [ $? -eq 1 ]
    printf '<pre>weave %s\n%s</pre>\n' "$*" "$(in_html < "$made/$name.txt")" >> "$page"
}

fig1() {
    heading "Figure 1: three colours, two layers"
    sample three-colour-stencil
    relax three-colour-stencil fig1-whole --fidelity draft
    relax three-colour-stencil fig1-before --region picks:65-100,ends:35-66
    relax three-colour-stencil fig1-after --region picks:65-100,ends:35-66 --flip 86,42 --flip 92,44
    pictures
    picture three-colour-stencil.weave face fig1-face "The face as it is drawn"
    picture fig1-whole.yarns 3d fig1-whole "All of it, relaxed in draft" --side top --size 540x540
    picture fig1-before.yarns 3d fig1-before "The tip of a petal as it was drawn, from pick 81 on" --side top --cut 20,0,0:-1,0,0 --size 640x420
    picture fig1-after.yarns 3d fig1-after "After two flips at its left edge: picks 86 and 92 lie over ends 42 and 44" --side top --cut 20,0,0:-1,0,0 --size 640x420
    done_with_pictures
    measured fig1 apart fig1-before.yarns fig1-after.yarns
}

fig3() {
    heading "Figure 3: simple weaves and their cards"
    sample plain twill-2-2 satin-5
    pictures
    local name
    for name in plain twill-2-2 satin-5; do
        picture $name.weave block "fig3-$name-block" "$name, the block"
        picture $name.weave card "fig3-$name-card" "$name, the card"
    done
    done_with_pictures
}

fig4() {
    heading "Figure 4: a baby shoe"
    sample shoe-baby
    told fig4-blocks info shoe-baby.weave
    relax shoe-baby fig4 --wraparound --fidelity draft --steps 300
    pictures
    picture shoe-baby.weave card fig4-card "The card image"
    picture shoe-baby.weave weft:41 fig4-heel "Slice 1, in the heel: four picks a row" --from-end 57
    picture shoe-baby.weave weft:145 fig4-middle "Slice 2, through the ankle: six picks a row" --from-end 33
    picture fig4.yarns 3d fig4-shoe "As far as 300 steps go" --side corner --size 640x480
    picture fig4.yarns 3d fig4-cut "The same, cut through the ankle" --side front --cut x=45 --size 640x360
    done_with_pictures
}

fig5() {
    heading "Figure 5: a clipping plane; the window itself is in docs/pictures/studio"
    sample layer-to-layer
    relax layer-to-layer fig5
    pictures
    picture fig5.yarns 3d fig5-cut "Cut across the ends" --cut x=2.2 --repeat 1x2 --size 600x400
    done_with_pictures
}

fig6() {
    heading "Figure 6: block, stacks and card"
    sample satin-5 twill-g
    told fig6-satin info satin-5.weave
    pictures
    picture satin-5.weave warp:1 fig6-satin-slice "One layer, the stacks of end 1"
    picture twill-g.weave warp:1 fig6-twill-slice "Two layers, the stacks of ends 1 and 2"
    picture twill-g.weave card fig6-twill-card "Two layers, the card image"
    picture twill-g.weave layers fig6-twill-layers "The same, layer by layer"
    done_with_pictures
}

fig7() {
    heading "Figure 7: both ways to see a weft"
    sample pocket
    sed 's/"weft_mode": "wraparound"/"weft_mode": "periodic"/' "$made/pocket.weave" > "$made/pocket-periodic.weave"
    pictures
    picture pocket-periodic.weave weft:11 fig7-periodic "Periodic: each pick runs from edge to edge" --from-end 31
    picture pocket.weave weft:11 fig7-wraparound "Wraparound: the weft turns where an end catches it" --from-end 31
    done_with_pictures
}

fig8() {
    heading "Figure 8: a stencil"
    "$weave" preset satin size=5 move=2 -o "$made/satin.weave" > /dev/null
    "$weave" preset sateen size=5 move=2 -o "$made/sateen.weave" > /dev/null
    cp docs/pictures/heart.png "$made/heart.png"
    told fig8-stencil stencil heart.png --map '#ff0000=sateen.weave' --map '#ffffff=satin.weave' -o heart.weave
    pictures
    picture satin.weave card fig8-satin "Block 1"
    picture sateen.weave card fig8-sateen "Block 2"
    picture heart.weave card fig8-card "Merged: the card"
    picture heart.weave face fig8-face "Merged: the face"
    done_with_pictures
}

# A twill with one blue pick under a red and a green end.
fig9() {
    heading "Figure 9: a pick led over two ends in relaxed cloth"
    cat > "$made/lead.weave" <<'WEAVE'
{"format": "weave", "version": 1, "title": "A pick led over two ends", "root": "cloth",
 "blocks": {"repeat": {"kind": "preset", "family": "twill", "options": {"up": 2, "down": 2}},
            "cloth": {"kind": "tile", "of": "repeat", "x": 2, "y": 2}},
 "warp": {"colours": ["#c0392b", "#2e8b57"], "colour_order": "0 0 0 1 2 0 0 0"},
 "weft": {"yarns": [{"name": "grey", "colour": "#8f959b"}, {"name": "blue", "colour": "#2c5fb8"}],
          "feeders": [{"name": "grey", "yarn": 0}, {"name": "blue", "yarn": 1}], "feeder_order": "0 0 0 1 0 0 0 0"}}
WEAVE
    relax lead fig9-before
    relax lead fig9-first --flip 4,4
    relax lead fig9-after --flip 4,4 --flip 4,5
    pictures
    local run
    for run in before first after; do
        picture fig9-$run.yarns 3d fig9-$run "$run" --side 20,40 --cut x=1.30 --size 600x420
    done
    done_with_pictures
}

fig10() {
    heading "Figure 10: 3D structures"
    local name
    for name in layer-to-layer angle-interlock-a angle-interlock-b orthogonal hexagon-tubes; do
        sample $name
        relax $name fig10-$name
        pictures
        picture $name.weave warp:1 fig10-$name-slice "$name: a slice"
        picture $name.weave card fig10-$name-card "$name: the card"
        picture fig10-$name.yarns 3d fig10-$name-relaxed "$name: relaxed" --size 560x380
        picture fig10-$name.yarns 3d fig10-$name-side "$name: from the side" --side right --size 600x320
        done_with_pictures
    done
    measured fig10-layer-to-layer neighbours fig10-layer-to-layer.yarns
}

fig11() {
    heading "Figure 11: two-layer satin and twill"
    local name
    for name in satin-e twill-g; do
        sample $name
        relax $name fig11-$name
        pictures
        picture fig11-$name.yarns 3d fig11-$name "$name, relaxed" --repeat 2x2 --size 600x420
        picture fig11-$name.yarns 3d fig11-$name-height "$name, by height" --side top --colour height --repeat 2x3 --size 600x460
        done_with_pictures
    done
    measured fig11-twill-g dent fig11-twill-g.yarns 8
    measured fig11-satin-e dent fig11-satin-e.yarns 5
}

fig12() {
    heading "Figure 12: TL013"
    sample tl013-wrong tl013-corrected
    told fig12-diff diff tl013-wrong.weave tl013-corrected.weave -o fig12-diff.png
    local version
    for version in wrong corrected; do
        relax tl013-$version fig12-$version
        measured fig12-$version lean fig12-$version.yarns
        pictures
        picture fig12-$version.yarns 3d fig12-$version "$version, from the last end, cut in the middle" --side right --cut y=4 --size 1000x340
        done_with_pictures
    done
    pictures
    shown fig12-diff "The corrected card, and in what it differs"
    done_with_pictures
}

fig13() {
    heading "Figure 13: a pocket, closed and pulled open"
    sample pocket
    relax pocket fig13-closed --field none --fidelity draft --steps 1500
    relax pocket fig13-open --fidelity draft --steps 1500
    pictures
    local run
    for run in closed open; do
        picture fig13-$run.yarns 3d fig13-$run "$run" --side 60,8 --size 600x400
        picture fig13-$run.yarns 3d fig13-$run-cut "$run, cut through the middle" --side front --cut x=13 --size 600x340
    done
    done_with_pictures
}

fig14() {
    heading "Figure 14: an I-beam"
    sample i-beam
    told fig14-checked check i-beam.weave --loom "$PWD/db/looms/tc2.json"
    relax i-beam fig14 --wraparound --steps 6000
    pictures
    picture i-beam.weave weft:4 fig14-slice "A slice along the weft; purple: placeholders"
    picture i-beam.weave card fig14-card "The card image"
    picture fig14.yarns 3d fig14-relaxed "Relaxed, cut across the ends" --side front --cut x=2.5 --size 640x440
    done_with_pictures
}

fig15() {
    heading "Figure 15: a toddler shoe"
    sample shoe-toddler
    told fig15-blocks info shoe-toddler.weave
    pictures
    picture shoe-toddler.weave face fig15-face "The face, loose yarns trimmed" --trim
    picture shoe-toddler.weave weft:199 fig15-middle "A slice along the weft through the ankle" --from-end 141
    picture shoe-toddler.weave warp:94 fig15-warp "A slice along the warp near the toe: sole, insole, top" --from-pick 537
    done_with_pictures
}

fig16() {
    heading "Figure 16: details of the adult shoe"
    sample shoe-adult
    pictures
    picture shoe-adult.weave weft:3000 fig16-middle "Through the middle: sole, insole, upper" --from-end 1081 --to-end 1200
    picture shoe-adult.weave weft:3000 fig16-rim "At the rim: ends that bind nothing" --from-end 541 --to-end 660
    done_with_pictures
}

fig17() {
    heading "Figure 17: the adult shoe"
    sample shoe-adult
    told fig17-blocks info shoe-adult.weave
    pictures
    picture shoe-adult.weave face fig17-face "The face" --trim
    done_with_pictures
}

fig18() {
    heading "Figure 18: a flip that can be, and one that cannot"
    sample satin-e
    told fig18-accepted flip satin-e.weave --pick 1 --end 1 -o flipped.weave
    told fig18-refused flip satin-e.weave --pick 2 --end 1 -o refused.weave
    told fig18-diff diff satin-e.weave flipped.weave
    pictures
    picture satin-e.weave weft:1 fig18-before "Row 1 as it is"
    picture flipped.weave weft:1 fig18-after "Row 1 after the flip"
    done_with_pictures
}

fig19() {
    heading "Figure 19: ends that pass one another in one slice"
    sample orthogonal
    relax orthogonal fig19 --steps 0
    pictures
    picture fig19.yarns 3d fig19-corner "As planned, from the corner" --size 600x420
    picture fig19.yarns 3d fig19-top "From above" --side top --size 600x420
    picture fig19.yarns 3d fig19-side "From the side" --side right --size 600x420
    done_with_pictures
}

# What the paper's text claims of a cloth, measured on its yarns.
measured() { # NAME WHAT [FILE or ARGUMENT...]
    (cd "$made" && python3 "$OLDPWD/tools/paper_measures" "${@:2}") > "$made/$1-$2.txt"
    printf '<pre>tools/paper_measures %s\n%s</pre>\n' "${*:2}" "$(in_html < "$made/$1-$2.txt")" >> "$page"
}

# A structure of Table 1 with as many control points as the paper's, by both solvers, one thread: a row each of table1.md. Processor
# time is told beside seconds, since it hardly depends on what else the machine does.
table_row() { # DESIGN NAME POINTS_A_CROSSING PAPER_POINTS PAPER_SECONDS [OPTION...]
    local solver steps cpu changed
    for solver in relax paper; do
        steps=3000
        [ $solver = relax ] || steps=15000
        TIMEFORMAT=%U
        cpu=$({ time { "$weave" simulate "$made/$1.weave" --points "$3" --solver $solver --threads 1 --steps $steps "${@:6}" \
            -o "$made/table1.yarns" > "$made/table1.txt" 2> /dev/null || [ $? -eq 1 ]; }; } 2>&1)
        changed=$(sed -nE 's/^([0-9]+) crossings? no longer as the card says.*/\1/p' "$made/table1.txt")
        sed -nE '1s/.* residual ([0-9.e+-]+) .* after ([0-9]+) steps and ([0-9.]+) s, ([0-9]+) points.*/\1 \2 \3 \4/p' "$made/table1.txt" |
            awk -v name="$2" -v solver=$solver -v cpu="$cpu" -v changed="${changed:-0}" -v points="$4" -v theirs="$5" '{
                printf "| %s | `%s` | %s (%s) | %s | %s | %s | %s | %s | %.2f | %s | %.1f |\n",
                    name, solver, $4, points, $1, changed, $2, $3, cpu, 1000 * cpu / $2, theirs, theirs / cpu
            }' >> "$made/table1.md"
    done
}

table1() {
    heading "Table 1, control points matched"
    sample satin-e twill-g layer-to-layer angle-interlock-a angle-interlock-b hexagon-tubes tl013-corrected pocket
    "$weave" tile "$made/layer-to-layer.weave" --x 3 --y 4 -o "$made/layer-to-layer-3x4.weave" > /dev/null
    {
        echo "| Structure | Solver | Points (paper) | Residual | Changed crossings | Steps | Seconds | Processor s | ms a step | Paper's GPU s | its ratio |"
        echo "|---|---|---|---|---|---|---|---|---|---|---|"
    } > "$made/table1.md"
    table_row satin-e "Satin E" 3.46 692 3.16
    table_row twill-g "Twill G" 2.777 711 5.1
    table_row layer-to-layer-3x4 "Layer to layer, 3 × 4 repeats" 3.56 3075 10.5 --whole
    table_row angle-interlock-a "Angle interlock A" 3.734 1867 29.54
    table_row angle-interlock-b "Angle interlock B" 2.82 1444 60.49
    table_row hexagon-tubes "Hexagon tubes" 3.693 2127 81.13
    table_row tl013-corrected "TL013, corrected" 4.678 4491 62.49
    table_row pocket "Pocket, closed" 2.116 12751 15.5 --field none
    table_row pocket "Pocket, open" 2.116 12751 15.5
    printf '<pre>%s</pre>\n' "$(in_html < "$made/table1.md")" >> "$page"
}
