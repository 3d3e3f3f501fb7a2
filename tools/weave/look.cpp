// Commands that show a design: in numbers, as its card image, as pictures.

#include "command.hpp"
#include "progress.hpp"

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/io/wif.hpp>
#include <weave/picture/cloth_view.hpp>
#include <weave/picture/picture.hpp>

#include <algorithm>
#include <memory>
#include <optional>

namespace weave::program {

namespace {

const std::vector<std::string> kind_names{"stacks", "card",   "preset",  "slice",
                                          "tile",   "attach", "stencil", "renumber"};

/// One line a block: what it is and what it is made from.
Json tree_of(const Design& design) {
    Json tree = Json::array();
    for (const auto& [name, node] : design.blocks) {
        tree.push_back({{"name", name},
                        {"kind", kind_names[node->source.index()]},
                        {"of", children_of(*node)},
                        {"flips", node->flips.size()}});
    }
    return tree;
}

std::string tree_in_words(const Design& design) {
    std::string text;
    for (const auto& [name, node] : design.blocks) {
        text += (name == design.root ? "  * " : "    ") + name + "  " + kind_names[node->source.index()];
        const std::vector<std::string> children = children_of(*node);
        for (std::size_t k = 0; k < std::min<std::size_t>(children.size(), 6); ++k)
            text += (k == 0 ? " of " : ", ") + children[k];
        if (children.size() > 6) text += " and " + std::to_string(children.size() - 6) + " more";
        if (!node->flips.empty()) text += ", " + counted(node->flips.size(), "flip");
        text += "\n";
    }
    return text;
}

Status tell_info(CommandOutcome& outcome, const std::string& file) {
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, file));
    note_stray_pin(outcome, cloth, file);
    const Block& block = *cloth.evaluation.block;
    const std::string card = block.card_image().sha256(), design = design_sha256(cloth.design);
    const Json json{{"title", cloth.design.title},
                    {"rows", block.rows()},
                    {"columns", block.columns()},
                    {"height", block.height()},
                    {"picks", block.picks()},
                    {"ends", block.ends()},
                    {"blocks", cloth.design.blocks.size()},
                    {"different_stacks", block.stacks().size()},
                    {"card_sha256", card},
                    {"design_sha256", design},
                    {"scene_sha256", scene_sha256(cloth.design)},
                    {"lost_flips", cloth.evaluation.lost_flips.size()},
                    {"tree", tree_of(cloth.design)}};
    outcome.answer(
        json, on_one_line(cloth.design.title.empty() ? file : cloth.design.title) + "\n" + "picks    " +
                  std::to_string(block.picks()) + " in " + counted(block.rows(), "row") + "\n" + "ends     " +
                  std::to_string(block.ends()) + " in " + counted(block.columns(), "column") + "\n" +
                  "height   " + std::to_string(block.height()) + "\n" + "card     " + card + "\n" +
                  "design   " + design + "\n" + "blocks   " + std::to_string(cloth.design.blocks.size()) +
                  " (* is the cloth)\n" + tree_in_words(cloth.design));
    return {};
}

void add_info(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "info", "Tell a design's size, hashes and tree of blocks");
    const auto file = std::make_shared<std::string>();
    command->add_option("FILE", *file, "the .weave file")->required();
    on_run(command, outcome, [=, &outcome] { return tell_info(outcome, *file); });
}

bool has_loose_yarns(const Block& block) {
    return std::ranges::any_of(block.stacks(), [](const Stack& stack) {
        return std::ranges::any_of(stack.slots(), [](Slot slot) { return slot.is_loose(); });
    });
}

/// What a design has and WIF cannot hold, in the weaver's words; empty where nothing is lost but its tree.
std::string lost_in_wif(const Cloth& cloth) {
    const Scene usual;
    const Scene& scene = cloth.design.scene;
    Scene rest = scene;
    rest.weft_mode = usual.weft_mode;
    rest.boundary_x = usual.boundary_x;
    rest.boundary_y = usual.boundary_y;
    rest.pins.clear();
    rest.fields.clear();
    std::string lost;
    const auto add = [&](bool has, const char* what) {
        if (has) lost += (lost.empty() ? "" : ", ") + std::string(what);
    };
    add(has_loose_yarns(*cloth.evaluation.block), "which yarns are loose on purpose");
    const auto bare = [](const std::vector<std::uint32_t>& counts) { return std::ranges::count(counts, 0U) > 0; };
    add(bare(cloth.evaluation.block->t()), "the rows without picks");
    add(bare(cloth.evaluation.block->p()), "the columns without ends");
    add(scene.weft_mode == WeftMode::wraparound, "that the wefts turn (weft_mode wraparound)");
    add(scene.boundary_x != usual.boundary_x || scene.boundary_y != usual.boundary_y, "the boundaries");
    add(!scene.pins.empty(), "the pins");
    add(!scene.fields.empty(), "the fields");
    add(rest != usual, "the rest of the scene");
    return lost;
}

/// The design as WIF, read back and its card compared. WIF fixes the orientation itself.
Result<std::string> card_as_wif(const Cloth& cloth, const CardImage& card) {
    WEAVE_TRY(std::string bytes, write_wif(cloth.design, *cloth.evaluation.block, card));
    WEAVE_TRY(const DesignFromWif back, read_wif(bytes));
    WEAVE_TRY(const Evaluation again, evaluate(back.design));
    if (again.block->card_image() != card)
        return system_fault("the WIF file does not read back as the card that it was; nothing is written");
    return bytes;
}

Status write_card(CommandOutcome& outcome, const std::string& file, const std::string& out,
                  const BitmapReading& reading, const std::string& given_option) {
    const bool wif = lower_extension(out) == ".wif";
    const Result<BitmapFormat> format = bitmap_format_of(out);
    if (!wif && !format)
        return Error{ErrorCode::usage, "a card's name ends in .png, .tif, .tiff, .bmp or .wif", out};
    if (wif && !given_option.empty())
        return Error{ErrorCode::usage,
                     given_option + " is for pictures; WIF says itself how it is to be read", out};
    WEAVE_CHECK_OK(keep_apart(out, file, "the design that is read"));
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, file));
    const Progress progress("writing " + out);
    const CardImage card = cloth.evaluation.block->card_image();
    const Result<std::string> bytes =
        wif ? card_as_wif(cloth, card) : write_proven_bitmap(card, *format, reading);
    if (!bytes) return Error(bytes.error()).in(out);
    WEAVE_CHECK_OK(write_file(out, *bytes));
    const std::string lost = wif ? lost_in_wif(cloth) : "";
    if (!lost.empty()) outcome.note(out + ": WIF cannot hold, and the file does not say: " + lost);
    outcome.answer(
        {{"file", out}, {"picks", card.picks()}, {"ends", card.ends()}, {"card_sha256", card.sha256()}},
        on_one_line(out) + ": " + counted(card.picks(), "pick") + " and " + counted(card.ends(), "end") +
            "\n");
    return {};
}

void add_card(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "card",
                    "Write the card image: bottom row pick 1, left column end 1, black = end lifted");
    const auto file = std::make_shared<std::string>();
    const auto out = std::make_shared<std::string>();
    const auto reading = std::make_shared<BitmapReading>();
    command->add_option("FILE", *file, "the .weave file")->required();
    command->add_option("-o,--out", *out, "the file to write: .png, .tif, .bmp or .wif")
        ->type_name("FILE")
        ->required();
    add_reading_options(command, reading);
    on_run(command, outcome, [=, &outcome] {
        return write_card(outcome, *file, *out, *reading, given_reading_option(command));
    });
}

struct Rendering {
    std::string file, view, out;
    bool trim = false;
    PictureSpan span;
    ClothWords cloth;  ///< how relaxed cloth is looked at
    std::string given_3d_option;  ///< the first of the options for `cloth` that was given
    std::string given_flat_option;  ///< the first of those for pictures of designs
};

Status render_cloth(CommandOutcome& outcome, const Rendering& wish) {
    if (!wish.given_flat_option.empty())
        return Error{ErrorCode::usage, wish.given_flat_option + " is for pictures of designs", "--view 3d"};
    WEAVE_TRY(ClothView view, parse_cloth_view(wish.cloth));
    WEAVE_TRY(view.format, picture_format_of(wish.out));
    WEAVE_TRY(const Yarns yarns, load_cloth(wish.file));
    const Progress progress("drawing " + wish.out);
    WEAVE_TRY(const std::string bytes, draw_cloth(yarns, view));
    WEAVE_CHECK_OK(write_file(wish.out, bytes));
    outcome.answer({{"file", wish.out}, {"view", "3d"}, {"bytes", bytes.size()}}, on_one_line(wish.out) + ": 3d\n");
    return {};
}

/// Pictures of designs have no camera: an option for one would be passed over in silence.
Status refuse_3d_options(const Rendering& wish) {
    if (wish.given_3d_option.empty()) return {};
    return Error{ErrorCode::usage, wish.given_3d_option + " is for --view 3d", "--view " + wish.view};
}

Status render(CommandOutcome& outcome, const Rendering& wish) {
    WEAVE_CHECK_OK(keep_apart(wish.out, wish.file, "the file that is read"));
    if (wish.view == "3d") return render_cloth(outcome, wish);
    WEAVE_CHECK_OK(refuse_3d_options(wish));
    const auto& [file, view, out, trim, span, cloth_words, given_3d_option, given_flat_option] = wish;
    WEAVE_TRY(const PictureFormat format, picture_format_of(out));
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, file));
    const Progress progress("drawing " + out);
    WEAVE_TRY(PictureRequest request, parse_view(view, *cloth.evaluation.block));
    WEAVE_CHECK_OK(show_span(request, *cloth.evaluation.block, span));
    request.trim = trim;
    WEAVE_TRY(const std::string bytes, draw(cloth.design, cloth.evaluation, request, format));
    WEAVE_CHECK_OK(write_file(out, bytes));
    outcome.answer({{"file", out}, {"view", view}, {"bytes", bytes.size()}},
                   on_one_line(out) + ": " + on_one_line(view) + "\n");
    return {};
}

void add_render(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "render",
                                    "Draw a design: card, face, back, floats, layers, slices, or the block");
    const auto wish = std::make_shared<Rendering>();
    command->add_option("FILE", wish->file, "the .weave file; for 3d the .yarns file of `weave simulate`")->required();
    command
        ->add_option("--view", wish->view,
                     "card, face, back, floats, layers, weft:N, warp:N (pick or end N, from 1), block or 3d")
        ->type_name("VIEW")
        ->required();
    command->add_flag("--trim", wish->trim, "leave out yarns that are loose on purpose");
    command
        ->add_option("--from-pick", wish->span.from_pick,
                     "for warp:N and block: begin at this pick, where the cloth is too large to show whole")
        ->transform(whole_number())
        ->type_name("N");
    command->add_option("--to-pick", wish->span.to_pick, "for warp:N and block: end at this pick; up to 60 rows are shown")
        ->transform(whole_number())
        ->type_name("N");
    command->add_option("--from-end", wish->span.from_end, "for weft:N and block: begin at this end")
        ->transform(whole_number())
        ->type_name("N");
    command->add_option("--to-end", wish->span.to_end, "for weft:N and block: end at this end; up to 60 columns are shown")
        ->transform(whole_number())
        ->type_name("N");
    command->add_option("--side", wish->cloth.side, "3d: top, bottom, front, back, left, right, corner, or AZIMUTH,ELEVATION")
        ->type_name("SIDE");
    command->add_option("--cut", wish->cloth.cut, "3d: cut away what lies before a plane: x=N, y=N or z=N in mm, or PX,PY,PZ:NX,NY,NZ")
        ->type_name("PLANE");
    command->add_option("--colour", wish->cloth.colour, "3d: yarn, strain, contact, moved or height")->type_name("WORD");
    command->add_option("--repeat", wish->cloth.repeat, "3d: NxM periodic pieces side by side")->type_name("NxM");
    command->add_option("--size", wish->cloth.size, "3d: WIDTHxHEIGHT in pixels")->type_name("WxH");
    command->add_flag("--perspective", wish->cloth.perspective, "3d: a mild perspective");
    command->add_option("-o,--out", wish->out, "the picture to write: .png or .svg")
        ->type_name("FILE")
        ->required();
    on_run(command, outcome, [=, &outcome] {
        wish->given_3d_option = given_of(command, {"--side", "--cut", "--colour", "--repeat", "--size", "--perspective"});
        wish->given_flat_option = given_of(command, {"--trim", "--from-pick", "--to-pick", "--from-end", "--to-end"});
        return render(outcome, *wish);
    });
}

}  // namespace

Result<PictureFormat> picture_format_of(const std::string& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".png") return PictureFormat::png;
    if (extension == ".svg") return PictureFormat::svg;
    return Error{ErrorCode::usage, "a picture's name ends in .png or .svg", file};
}

void add_look_commands(CLI::App& app, CommandOutcome& outcome) {
    add_info(app, outcome);
    add_card(app, outcome);
    add_render(app, outcome);
}

}  // namespace weave::program
