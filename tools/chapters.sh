# The story that tools/demo tells: one cloth from its slices to the loom and back. Sourced by it, after story.sh, mill.sh and box.sh. Each
# function is a chapter. What one step needs of another (the place of the flaw, folders of releases) is read from what the programs said.

tell_the_story() {
    story_head "One cloth, from the first slice to the loom" "A two-layer cloth with ginkgo leaves. Dora designs it, Abel approves it, Otto weaves it on two \
looms, Edda audits, and Mary looks after the mill’s server. Everything on this page was run by <code>tools/demo</code>: each command stands as it was typed, with its answer."
    slices
    stencil
    two_looms
    relaxing
    mending
    approval
    release
    independent_reader
    recall
    audit
    epilogue
    story_tail
}

slices() {
    chapter "Three weaves, written as slices"
    cp tools/demo_input/*.slices tools/demo_input/yarns.weave tools/demo_input/*.png db/looms/tc2.json db/looms/ep-2688.json "$made/"
    text "A slice is a cut along an end: the picks are dots, the ends are paths between them. Each weave is eight slices side by side, written as a line for \
each position along the slice, from the bottom up; the studio’s section editor draws the same. All three are double cloths, with a gold and a blue weft that change places, and every second row stitches the layers together."
    tell dora 0 head -n 23 leaf.slices
    local name
    for name in ground leaf shade; do tell dora 0 weave slices $name.slices --yarns yarns.weave --title "${name^}" -o $name.weave; done
    pictures
    for name in ground leaf shade; do
        draw $name.weave warp:1 $name-slice "<code>$name.weave</code>: its first slice. Dots are picks, lines are ends."
    done
    draw leaf.weave weft:1 leaf-weft "The leaf cut along its first two picks"
    draw leaf.weave block leaf-block "The leaf as a block: gold above, blue below"
    draw shade.weave face shade-face "The shade from above: it binds on a twill line"
    pictures_end
    tell dora 0 weave simulate leaf.weave -o leaf.yarns
    pictures two
    draw leaf.yarns 3d leaf-cloth "The leaf at rest, two repeats each way" "" --side corner --repeat 2x2
    draw leaf.yarns 3d leaf-layers "Seen along the weft: two layers, and the ends that stitch them" "" --side right --repeat 2x2
    pictures_end
}

stencil() {
    chapter "A picture says where each weave goes"
    text "The leaves are painted in three colours, one pixel for each stack of yarns. Where the leaf ends and the ground begins, the layers change places."
    tell dora 0 weave stencil leaves.png --map '#1f3a5f=ground.weave' --map '#e0a830=leaf.weave' --map '#b0741c=shade.weave' -o ginkgo.weave
    pictures two
    figure leaves.png "<code>leaves.png</code>, as it was painted" "big drawn"
    draw ginkgo.weave face face "The face of the cloth, as it will look" big
    pictures_end
    pictures two
    draw ginkgo.weave back back "Its back: the same leaves in blue"
    draw ginkgo.weave card card-drawn "The card: black is a lifted end, pick 1 at the bottom"
    pictures_end
}

two_looms() {
    chapter "Held to two looms, which find a flaw"
    text "The mill has a TC2 in the sample room and an EP loom of 2,688 hooks. Every rule of both is asked before anything is simulated."
    tell dora 0 weave check ginkgo.weave --loom tc2.json
    read -r pick first last < <(long_float "$scratch/said") || { echo "== FAILED: the loom found no float that is too long" >&2; return 5; }
    tell dora 0 weave check ginkgo.weave --loom ep-2688.json
    text "It fits on both, with one finding: <strong>pick $pick floats too far, from end $first to $last</strong>. Neither weave has such a float: the outline between leaf and \
shade falls just so that one binding point is missing. Such a loop catches on everything."
    say "   pick $pick floats from end $first to $last"
    pictures
    draw ginkgo.weave "weft:$pick" flaw-slice "The cloth cut along pick $pick: the gold weft runs free from end $first to $last" wide --from-end $((first - 4)) --to-end $((last + 8))
    draw ginkgo.weave floats floats "How far each yarn floats, on both faces" wide
    pictures_end
}

# PICK FIRST LAST of the first float on the face that a loom's rules name.
long_float() { # FILE
    sed -nE 's/^[a-z]+ +float\.face +pick ([0-9]+) floats .* from end ([0-9]+) to ([0-9]+);.*/\1 \2 \3/p' "$1" | head -n 1 | grep .
}

# The part of the cloth that is relaxed: the float, and so much round it that the held rims do not disturb it. It begins with a whole row and column.
around_the_flaw() {
    local above=$((pick > 24 ? pick - 24 : 1)) left=$((first > 12 ? first - 12 : 1))
    part=picks:$above-$((pick + 23)),ends:$left-$((last + 12))
}

relaxing() {
    chapter "Relaxed on the mill’s simulation machine, which is killed in the middle"
    serve_mill
    set_up_mill
    set_up_box
    serve_box
    around_the_flaw
    text "How does the cloth lie there? Dora has the part round the float relaxed on <code>simd</code>, which knows her by a token of the mill. \
Once her job has a first checkpoint the daemon is killed, as by a fault of the machine, and started again; the job goes on from there, and her command waits."
    local command=(weave simulate ginkgo.weave --region "$part" --residual 1e-4 -o part.yarns --on "$box_place" --fingerprint "$box_fingerprint")
    simulate_and_kill "${command[@]}"
    put_on_page dora 0 "$(typed "${command[@]}")"
    text "The daemon that was killed (SIGKILL) was process $box_killed; the first lines are what Dora’s command noticed of it."
    say "   $(grep -m 1 'at rest' "$scratch/said")"
    tell dora 0 weave inspect part.yarns
    place=$(place_of_pick part.yarns "$pick")
    pictures two
    draw part.yarns 3d part-top "The part at rest, from above. The long gold weft in the middle, with nothing over it, is pick $pick." big --side top --size 1400x1200
    draw part.yarns 3d part-corner "The same from a corner: the leaf ends at the lower right" big --side corner --size 1400x1200
    draw part.yarns 3d part-contact "How hard the yarns press on one another" wide --side top --colour contact
    draw part.yarns 3d part-cut "Cut along pick $pick: between the ends that hold it the gold weft arches up and lies loose" wide --size 1600x420 --side front --cut "x=$place"
    pictures_end
}

# Where a pick of relaxed cloth lies on average, in mm along the ends.
place_of_pick() { # YARNS PICK
    "$weave" export-yarns "$made/$1" -o "$scratch/yarns.obj" > /dev/null
    awk -v yarn="pick_$2" '/^g / { here = $2 == yarn } here && /^v / { sum += $3; n++ } END { printf "%.2f", sum / n }' "$scratch/yarns.obj"
}

mending() {
    chapter "Mended by a flip, in cloth and card together"
    local end=$(((first + last) / 2))
    text "In the middle of the float one end comes up over the pick. The two yarns change sides in the relaxed cloth, which comes to rest again, and the flip goes \
into the design as well."
    tell dora 0 weave simulate ginkgo.weave --region "$part" --resume part.yarns --flip "$pick,$end" --save-design mended.weave -o mended.yarns
    pictures
    figure part-cut.png "Before: the cloth cut along pick $pick" wide
    draw mended.yarns 3d mended-cut "After: the gold weft dips under end $end" wide --size 1600x420 --side front --cut "x=$place"
    pictures_end
    tell dora 0 weave inspect mended.yarns
    text "What <code>inspect</code> says of yarns that lie bunched or have moved from the plan is how the cloth lies; it would end with 1 if the cloth were not at rest, leaned, or had a crossing other than on the card."
    tell dora 1 weave diff ginkgo.weave mended.weave -o difference.png
    tell dora 0 weave check mended.weave --loom tc2.json
    ! long_float "$scratch/said" > /dev/null || { echo "== FAILED: the float is still there" >&2; return 5; }
    tell dora 0 weave check mended.weave --loom ep-2688.json
    ! long_float "$scratch/said" > /dev/null || { echo "== FAILED: the float is still there" >&2; return 5; }
    text "The finding is gone on both looms."
    pictures two
    figure difference.png "One crossing of the card has changed, in the ring" big
    draw mended.weave face mended-face "The face of the mended cloth" big
    draw mended.weave "weft:$pick" mended-slice "The cloth cut along pick $pick again: end $end holds it" wide --from-end $((first - 4)) --to-end $((last + 8))
    pictures_end
    say "   end $end now holds pick $pick, and both looms are content"
}

approval() {
    chapter "Submitted with signed evidence, approved by another person"
    text "The mill asks for a simulation of this very design, signed by a machine that it knows; how much of the cloth it has to cover is the mill’s to say, and this one \
takes a part. Dora has the part round the mended place relaxed there once more, and gets the signature with the yarns."
    tell dora 0 weave simulate mended.weave --region "$part" -o proof.yarns --on "$box_place" --fingerprint "$box_fingerprint" --evidence proof.evidence
    stop_box
    rm -rf "$made/box"
    tell dora 0 loomlink design make ginkgo
    tell dora 0 loomlink save mended.weave ginkgo --message "Leaves, with pick $pick held"
    tell dora 0 loomlink submit ginkgo 1 --reason "Ready to weave" --password-file mill-password
    text "Without evidence nobody’s approval counts, and with it Dora’s own does not, though she may approve what others draw."
    tell abel 4 loomlink approve ginkgo 1 --reason "Looks good" --password-file mill-password
    tell dora 0 loomlink evidence add ginkgo 1 proof.evidence
    tell dora 4 loomlink approve ginkgo 1 --reason "I know it is good" --password-file mill-password
    look abel 'Abel Reed' /designs/ginkgo/1 'Still missing' approver-sees --whole
    look abel 'Abel Reed' /designs/ginkgo/1 'You approve exactly this revision' approver-signs --press 'Approve …'
    pictures
    seen approver-sees "What Abel has before him on the mill’s page: the card, who submitted it, what is still missing, and at the bottom the evidence, with the machine that signed it" wide
    seen approver-signs "By its button he would sign there what he signs here by a command" wide
    pictures_end
    tell abel 0 loomlink approve ginkgo 1 --reason "Looked at, face and back" --password-file mill-password
    tell abel 0 loomlink design show ginkgo 1
}

release() {
    chapter "Released for two looms, pulled and held to the signatures"
    text "The server writes the files for each loom, reads them back with decoders of their own, and Abel signs what they say."
    local loom
    for loom in TC2 'EP 1'; do
        tell abel 0 loomlink release ginkgo 1 --loom "$loom" --reason "For the autumn trial" --password-file mill-password
    done
    text "At the looms Otto pulls what is released and nothing else. The first time he gives the fingerprint by which he knows the mill."
    tell otto 0 loomlink pull TC2 --to at-the-tc2 --trust "$mill_trust"
    tell otto 0 loomlink pull 'EP 1' --to at-the-ep --trust "$mill_trust"
    for_tc2=$(cd "$made" && echo at-the-tc2/*) for_ep=$(cd "$made" && echo at-the-ep/*)
    tell otto 0 loomlink verify-files "$for_tc2" --loom TC2
    tell otto 0 loomlink verify-files "$for_ep" --loom 'EP 1'
    cp -r "$made/$for_ep" "$made/kept-by-otto"
    cp "$made/$for_ep"/*-card.png "$made/released-card.png"
    look otto 'Otto Shed' /looms/TC2/1 'Files for the controller' at-the-loom --tablet --whole
    pictures two
    figure released-card.png "The card as it was released, one pixel a crossing: pick 1 at the bottom, end 1 at the left, black lifts" "true"
    seen at-the-loom "On the tablet at the TC2: the files with their hashes, the pick to go to, the card and the order of the wefts"
    pictures_end
    text "The files: <a href=\"$for_tc2/\">for the TC2</a> a TIFF, a WIF and the table of picks, and for the EP loom its controller’s file, a WIF, the table and a picture, \
<a href=\"kept-by-otto/\">kept here</a> in a copy. Layout-compatible with observed files, not certified by the maker."
}

independent_reader() {
    chapter "Read by a program that knows the written formats alone"
    text "<code>tools/read_release</code> is Python with nothing of this project in it. It judges the signatures with OpenSSL, makes the card anew from every file, \
bit by bit, and compares it with the card of Dora’s design and the order of her wefts."
    tell edda 0 weave card mended.weave -o card.png
    local folder reading=(--trust trust.json --fingerprint "$mill_trust" --card card.png --design mended.weave)
    for folder in "$for_tc2 tc2.json" "$for_ep ep-2688.json"; do
        tell edda 0 read_release "${folder% *}" "${reading[@]}" --loom "${folder##* }" --picture "read-$(basename "${folder##* }" .json).png"
        say "   $(tail -n 1 "$scratch/said")"
    done
    pictures
    figure read-tc2.png "Drawn by <code>read_release</code>: first the card of Dora’s design, then what it made of the TC2’s TIFF and WIF" "true wide"
    figure read-ep-2688.png "The card of the design again, and what it made of the EP loom’s controller file, and below of its picture and its WIF. Nothing is ringed: all are the same" "true wide"
    pictures_end
    local file
    cp -r "$made/$for_ep" "$made/damaged"
    file=$(basename "$made"/damaged/*.ep)
    flip_one_bit "$made/damaged/$file"
    text "And if one bit of one byte is another? In a copy, one bit of <code>$file</code> is turned over."
    tell edda 1 read_release damaged "${reading[@]}" --picture read-damaged.png
    say "   one bit turned over: $(grep -m 1 'pick' "$scratch/said")"
    pictures
    figure read-damaged.png "Of the damaged copy: the crossing that its controller file has otherwise is in the red ring" "true wide"
    pictures_end
    tell otto 1 loomlink verify-files damaged --loom 'EP 1'
    rm -rf "$made/damaged"
}

# Of a byte among the hooks of the file's records.
flip_one_bit() { # FILE
    local at byte
    at=$(($(stat -c %s "$1") / 4))
    byte=$(od -An -tu1 -j $at -N 1 "$1" | tr -d ' ')
    printf "\\x$(printf %02x $((byte ^ 4)))" | dd of="$1" bs=1 seek=$at conv=notrunc status=none
}

recall() {
    chapter "A recall"
    text "First Edda takes the log’s signed head along, to hold the log to it later."
    tell edda 0 loomlink audit head -o head.json
    look otto 'Otto Shed' /looms/EP%201/1 'Files for the controller' before-the-recall --tablet
    text "The EP loom was set up with the wrong gold. Abel withdraws its release; the TC2’s stays in force. When Otto’s terminal asks the next time, the files go, and \
a copy that somebody kept is refused."
    tell abel 0 loomlink withdraw 'EP 1' 1 --reason "The wrong gold yarn on feeder 1" --password-file mill-password
    tell otto 0 loomlink pull 'EP 1' --to at-the-ep
    say "   $(head -n 2 "$scratch/said" | sed "s|$made/||g" | paste -sd ';' | sed 's/;/; /')"
    look otto 'Otto Shed' /looms/EP%201/1 'Recalled: do not weave it' after-the-recall --tablet
    pictures two
    seen before-the-recall "The release on the tablet at the EP loom, before"
    seen after-the-recall "The same page after: it says who recalled it, and why, and gives no file any more"
    pictures_end
    tell otto 4 loomlink verify-files kept-by-otto --loom 'EP 1'
    tell otto 0 loomlink loom show TC2
}

audit() {
    chapter "The audit"
    text "Edda sees who did what, and why, refusals included. The log is a chain of hashes with a signed head; she takes the whole of it along and proves offline that nothing was changed, \
removed or put in another order. By the head that she kept an older copy of the log would be found out."
    local from
    from=$(at_desk edda "$loomlink" log | sed -nE 's/^([0-9]+) .* design\.added .*/\1/p')
    tell edda 0 loomlink log --from "$from"
    tell edda 0 loomlink audit bundle -o log.json
    tell edda 0 loomlink audit verify log.json --trust trust.json --fingerprint "$mill_trust" --retained head.json
    say "   $(head -n 1 "$scratch/said")"
    ! grep 'does not name' "$scratch/said" >&2 || { echo "== FAILED: the trust document does not name the simulation machine" >&2; return 5; }
    look edda 'Edda Proof' /log 'The log holds:' the-log-holds --press 'Verify what is shown'
    pictures
    seen the-log-holds "The log on the mill’s page, the newest record first. By the button Edda’s browser proved itself that each record shown is in the signed tree" wide
    pictures_end
    stop_mill
}

epilogue() {
    chapter "What is here, and how long it took"
    text "The designs <a href=\"ginkgo.weave\">ginkgo.weave</a> and <a href=\"mended.weave\">mended.weave</a>, the weaves <a href=\"ground.weave\">ground</a>, \
<a href=\"leaf.weave\">leaf</a> and <a href=\"shade.weave\">shade</a>, relaxed yarns <a href=\"part.yarns\">before</a> and <a href=\"mended.yarns\">after</a> the flip, \
<a href=\"proof.evidence\">the signed evidence</a>, <a href=\"at-the-tc2/\">the TC2’s files</a>, <a href=\"log.json\">the log</a> and <a href=\"trust.json\">whose keys count</a>."
    text "The mill itself: <code>$(typed build/release/bin/loomlink serve "${folder#"$PWD"/}/mill" | in_html)</code>, then <a href=\"https://localhost:8443/\">https://localhost:8443/</a> as mary, dora, abel, \
otto or edda; the password of all is in <a href=\"mill-password\">mill-password</a>, for this is a story. The certificate is of the mill’s own making, so the browser asks first. \
<code>tools/paper</code> shows relaxed 3D structures, pockets and shoes."
    chapters_took
}
