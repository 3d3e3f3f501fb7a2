// Edits as they stand in journals and messages, one JSON object a line: refused, or made and undone exactly.
#include "support/must.hpp"
#include "support/small_cloth.hpp"

#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>

using namespace weave;
using fuzz::must;

namespace {

/// One block of each kind that an edit may come across: leaves, blocks that are made from others, a flip.
const Design& start() {
    static const Design design = [] {
        Design made;
        const auto put = [&](const char* name, NodeSource source) {
            made.blocks[name] = std::make_shared<const Node>(Node{std::move(source), {}});
        };
        put("plain", PresetLeaf{{"plain", {}}});
        put("twill", PresetLeaf{{"twill", {}}});
        put("wide", TileOperation{"plain", 2, 2, 1});
        put("both", AttachOperation{"wide", "wide", Face::plus_x});
        made.root = "both";
        const auto flipped = weave::apply_edit(made, PutFlip{"wide", {0, 1, true}});
        must(flipped && check(made), "the design to begin with is sound");
        return made;
    }();
    return design;
}

/// Makes one edit and checks it from all sides; gives what undoes it.
std::optional<Edit> try_edit(Design& design, std::string_view line) {
    const auto value = parse_json(line);
    if (!value) return {};
    const auto edit = edit_from_json(*value);
    if (!edit) {
        must(!edit.error().message.empty(), "a refusal says why");
        return {};
    }
    const Json written = to_json(*edit);
    const auto again = edit_from_json(written);
    must(again && to_json(*again) == written, "an edit reads as it was written");

    const Design before = design;
    auto undo = weave::apply_edit(design, *edit);
    if (!undo) {
        must(design == before, "a refused edit changes nothing");
        return {};
    }
    must(static_cast<bool>(check(design)), "a design that was edited is sound");
    const auto reread = read_document(write_document(design));
    must(reread && *reread == design, "whatever can be edited can be read again");
    Design undone = design;
    const auto redo = weave::apply_edit(undone, *undo);
    must(redo && undone == before, "undo restores the design");
    must(weave::apply_edit(undone, *redo) && undone == design, "redo makes the edit again");
    return std::move(undo).value();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    if (!fuzz::runs_are_short(text)) return 0;
    Design design = start();
    std::vector<Edit> undos;
    for (std::size_t at = 0; at < text.size() && undos.size() < 16;) {
        const std::string_view line = text.substr(at, text.find('\n', at) - at);
        at += line.size() + 1;
        if (auto undo = try_edit(design, line)) undos.push_back(std::move(*undo));
    }
    static_cast<void>(fuzz::small_cloth(design));
    for (; !undos.empty(); undos.pop_back())
        must(static_cast<bool>(weave::apply_edit(design, undos.back())), "every edit can be undone");
    must(design == start(), "undoing everything leads back to the start");
    return 0;
}
