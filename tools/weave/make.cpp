// Commands that make a design, or one from others; each result keeps its operation tree.

#include "command.hpp"
#include "progress.hpp"

#include <weave/core/exit_code.hpp>
#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/merge.hpp>
#include <weave/design/outline.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/io/slices_text.hpp>
#include <weave/io/stencil_picture.hpp>
#include <weave/samples/samples.hpp>

#include <algorithm>
#include <memory>

namespace weave::program {

namespace {

/// Makes `source` the new root of the design, under a name that tells what it is.
void put_root(Design& design, const std::string& name, NodeSource source) {
    const std::string free = free_name(design, name);
    design.blocks[free] = std::make_shared<const Node>(Node{std::move(source), {}});
    design.root = free;
}

Error usage_error(const std::string& message) {
    return {ErrorCode::usage, message, ""};
}

// ---- samples

void list_samples(CommandOutcome& outcome) {
    Json list = Json::array();
    std::string names;
    std::size_t longest = 0;
    for (const Sample& sample : samples()) longest = std::max(longest, sample.name.size());
    for (const Sample& sample : samples()) {
        list.push_back(
            {{"name", sample.name}, {"title", sample.title}, {"about", sample.about}, {"loom", sample.loom}});
        names += sample.name + std::string(longest + 2 - sample.name.size(), ' ') + sample.about.substr(0, sample.about.find(". ")) + "\n";
    }
    outcome.answer({{"samples", std::move(list)}}, names + "\nweave samples NAME -o FILE.weave writes one; --json tells more of each.\n");
}

void add_samples(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "samples", "List the designs that come with the program, or write one");
    const auto name = std::make_shared<std::string>();
    const auto out = std::make_shared<std::string>();
    command->add_option("NAME", *name, "the sample to write; without it they are listed, one a line");
    command->add_option("-o,--out", *out, "the .weave file to write")->type_name("FILE");
    on_run(command, outcome, [=, &outcome]() -> Status {
        if (name->empty()) {
            if (!out->empty()) return usage_error("-o needs the NAME of a sample");
            list_samples(outcome);
            return {};
        }
        const Sample* sample = find_sample(*name);
        if (sample == nullptr)
            return usage_error("there is no sample '" + *name + "'; 'weave samples' lists them");
        if (out->empty()) return usage_error("name the file to write, such as -o " + *name + ".weave");
        return save_cloth(outcome, sample->make(), *out, *name);
    });
}

// ---- preset

std::string preset_help() {
    std::string text = "Families, and their settings with what they are if left out:\n";
    for (const PresetFamily& family : preset_families()) {
        text += "  " + family.name + ": " + family.help + "\n";
        for (const PresetOption& option : family.options) {
            text += "      " + option.name + "=" + std::to_string(option.fallback) + "  " + option.help +
                    " (" + std::to_string(option.low) + " to " + std::to_string(option.high) + ")\n";
        }
    }
    return text;
}

Result<Preset> parse_preset(const std::string& family, const std::vector<std::string>& settings) {
    Preset preset{family, {}};
    for (const std::string& setting : settings) {
        const auto equals = setting.find('=');
        const std::string name = setting.substr(0, equals);
        const auto value =
            equals == std::string::npos ? std::nullopt : parse_whole(setting.substr(equals + 1));
        if (!value) return usage_error("'" + setting + "' is not a setting such as up=3");
        if (!preset.options.emplace(name, *value).second)
            return usage_error("setting '" + name + "' is given twice");
    }
    return preset;
}

void add_preset(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "preset", "Make a weave of a family by its rule");
    const auto family = std::make_shared<std::string>();
    const auto settings = std::make_shared<std::vector<std::string>>();
    const auto out = std::make_shared<std::string>();
    command->add_option("FAMILY", *family, "the family, see below")->required();
    command->add_option("SETTING", *settings,
                        "settings of the family as NAME=VALUE, such as up=3, as many as wanted");
    command->add_option("-o,--out", *out, "the .weave file to write")
        ->check(output_name())
        ->type_name("FILE")
        ->required();
    command->footer(preset_help);
    on_run(command, outcome, [=, &outcome]() -> Status {
        WEAVE_TRY(Preset preset, parse_preset(*family, *settings));
        if (Result<Block> made = make_preset(preset); !made) return usage_error(made.error().text());
        Design design;
        design.title = *family;
        put_root(design, *family, PresetLeaf{std::move(preset)});
        return save_cloth(outcome, design, *out, *family);
    });
}

// ---- slices

constexpr const char* slices_help =
    "FILE has a line for each position along a slice, what lies there from the bottom up: T0, T1 … are picks, P0, P1 … ends, a blank\n"
    "line parts two slices, and # begins a remark. Of a plain weave, two slices along the warp:\n"
    "  P0 T0   # the end passes under the first pick\n"
    "  T0 P0\n"
    "\n"
    "  T0 P0\n"
    "  P0 T0\n"
    "Dots count from 0 in each position, paths from 0 through the slice; (T1) is a pick that is switched off there.\n";

struct SlicesWish {
    std::string file, dots = "weft", yarns, title, out;
};

Status make_from_slices(CommandOutcome& outcome, const SlicesWish& wish) {
    WEAVE_CHECK_OK(keep_apart(wish.out, wish.file, "the text that is read"));
    constexpr std::uint64_t most_bytes = std::uint64_t{32} << 20;
    WEAVE_TRY(const std::string text, read_file(wish.file, most_bytes));
    auto slices = read_slices(text, wish.dots == "weft" ? System::weft : System::warp);
    if (!slices) return std::move(slices).error().in(wish.file);
    Design design = design_of_slices(std::move(*slices));
    design.title = wish.title.empty() ? std::filesystem::path(wish.out).stem().string() : wish.title;
    if (!wish.yarns.empty()) {
        WEAVE_TRY(const Design other, load_design(wish.yarns));
        design.warp = other.warp;
        design.weft = other.weft;
        design.scene = other.scene;
    }
    return save_cloth(outcome, design, wish.out, wish.file);
}

void add_slices(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "slices", "Make a design from slices written as text, side by side");
    const auto wish = std::make_shared<SlicesWish>();
    command->add_option("FILE", wish->file, "the text, see below")->required();
    command->add_option("--dots", wish->dots, "what the slices cut through: weft (slices along the warp, one a column; if nothing is said) or warp (along the weft, one a row)")
        ->check(one_of({"weft", "warp"}))
        ->type_name("SYSTEM");
    command->add_option("--yarns", wish->yarns, "a .weave file whose yarns, feeders and scene it gets; the usual ones if nothing is said")->type_name("FILE");
    command->add_option("--title", wish->title, "its title; the name of its file if nothing is said")->type_name("TEXT");
    command->add_option("-o,--out", wish->out, "the .weave file to write")->check(output_name())->type_name("FILE")->required();
    command->footer(slices_help);
    on_run(command, outcome, [=, &outcome] { return make_from_slices(outcome, *wish); });
}

// ---- tile, attach, renumber

void add_tile(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "tile",
                                    "Repeat a design along the warp (x), the weft (y) and in height (z)");
    const auto file = std::make_shared<std::string>();
    const auto out = std::make_shared<std::string>();
    const auto times = std::make_shared<TileOperation>();
    const CLI::Validator range = between(std::size_t{1}, most_times);
    command->add_option("FILE", *file, "the .weave file to repeat")->required();
    command->add_option("--x", times->x, "times along the warp, 1 if left out")->transform(range)->type_name("N");
    command->add_option("--y", times->y, "times along the weft")->transform(range)->type_name("N");
    command->add_option("--z", times->z, "times in height")->transform(range)->type_name("N");
    command->add_option("-o,--out", *out, "the .weave file to write")
        ->check(output_name())
        ->type_name("FILE")
        ->required();
    on_run(command, outcome, [=, &outcome]() -> Status {
        WEAVE_TRY(Design design, load_design(*file));
        times->of = design.root;
        put_root(design, design.root + "-tiled", *times);
        return save_cloth(outcome, design, *out, *file);
    });
}

void add_attach(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "attach",
                    "Join B to a face of A: +x after A's last row, +y after its last column, +z on top");
    const auto first = std::make_shared<std::string>();
    const auto second = std::make_shared<std::string>();
    const auto face = std::make_shared<std::string>();
    const auto out = std::make_shared<std::string>();
    command->add_option("A", *first, "the .weave file that keeps its yarns")->required();
    command->add_option("B", *second, "the .weave file to join to it")->required();
    command->add_option("--face", *face, "the face of A: +x, -x, +y, -y, +z or -z")
        ->required()
        ->check(one_of(face_names()))
        ->type_name("FACE");
    command->add_option("-o,--out", *out, "the .weave file to write")
        ->check(output_name())
        ->type_name("FILE")
        ->required();
    on_run(command, outcome, [=, &outcome]() -> Status {
        WEAVE_CHECK_OK(keep_apart(*out, *second, "the design that is joined to it"));
        WEAVE_TRY(Design design, load_design(*first));
        WEAVE_TRY(const Design other, load_design(*second));
        std::vector<std::string> warnings;
        if (!same_yarns(design, other))
            warnings.push_back(*second + ": its yarns and feeders are not those of " + *first +
                               " and are left out");
        const std::string name = bring_in(design, other);
        const auto at = std::find(face_names().begin(), face_names().end(), *face) - face_names().begin();
        design.title = std::filesystem::path(*out).stem().string();
        put_root(design, "attached", AttachOperation{design.root, name, static_cast<Face>(at)});
        return save_cloth(outcome, design, *out, *first + " and " + *second, warnings);
    });
}

void add_renumber(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "renumber",
                    "Change the insertion order of the picks of a row, or the order of the ends of a column");
    const auto file = std::make_shared<std::string>();
    const auto order = std::make_shared<std::vector<std::size_t>>();
    const auto line = std::make_shared<std::size_t>(0);
    const auto out = std::make_shared<std::string>();
    const CLI::Validator range = between(std::size_t{0}, std::size_t{1} << 28);
    command->add_option("FILE", *file, "the .weave file")->required();
    CLI::Option* row = command->add_option("--row", *line, "the row of the block, from 0 as in stacks")
                           ->transform(range)
                           ->type_name("ROW");
    CLI::Option* column = command->add_option("--column", *line, "the column of the block, from 0")
                              ->transform(range)
                              ->type_name("COLUMN");
    row->excludes(column);
    add_list(command, "--order", *order, std::size_t{0}, std::size_t{1} << 28,
             "the new order: for each place the old number within the row (or column), from 0, such as 1,0,2")
        ->required();
    command->add_option("-o,--out", *out, "the .weave file to write")
        ->check(output_name())
        ->type_name("FILE")
        ->required();
    on_run(command, outcome, [=, &outcome]() -> Status {
        if (row->count() + column->count() == 0) return usage_error("name a --row or a --column");
        WEAVE_TRY(Design design, load_design(*file));
        const System system = row->count() > 0 ? System::weft : System::warp;
        put_root(design, design.root + "-renumbered", RenumberOperation{design.root, system, *line, *order});
        return save_cloth(outcome, design, *out, *file);
    });
}

// ---- stencil

/// The map that a picture draws. A cloth that would be too large is refused before the picture's pixels are
/// read: `block` is one of the blocks, `sources` what an error of the cloth is said of.
Result<StencilMap> read_map(const std::string& picture, const std::map<Colour, std::uint16_t>& numbers,
                            const Design& block, const std::string& sources) {
    const Progress progress("reading " + picture);
    const Result<Outline> woven = outline(block);
    bool too_large = false;
    const auto fits = [&](std::size_t rows, std::size_t columns) -> Status {
        if (!woven) return {};  // which is told later, with its place
        Status status = check_stencil_size(woven->grid, rows, columns);
        too_large = !status;
        return status;
    };
    WEAVE_TRY(const std::string bytes, read_file(picture));
    Result<ColourImage> image = read_colour_image(bytes, fits);
    if (!image) return std::move(image).error().in(too_large ? sources : picture);
    Result<StencilMap> map = stencil_map(*image, numbers);
    if (!map) return std::move(map).error().in(picture);
    return map;
}

Status make_stencil(CommandOutcome& outcome, const std::string& picture, const std::vector<std::string>& mappings,
                    const std::string& out) {
    WEAVE_CHECK_OK(keep_apart(out, picture, "the picture that is read"));
    Design design;
    StencilOperation stencil;
    std::map<Colour, std::uint16_t> numbers;
    std::string sources = picture, first;
    std::vector<std::string> warnings;
    for (const std::string& mapping : mappings) {
        const auto equals = mapping.find('=');
        if (equals == std::string::npos)
            return usage_error("'" + mapping + "' is not a mapping such as #ff0000=twill.weave");
        const Result<Colour> colour = parse_colour(mapping.substr(0, equals));
        if (!colour) return usage_error(colour.error().message);
        if (!numbers.emplace(*colour, static_cast<std::uint16_t>(stencil.of.size())).second) {
            return usage_error("colour " + to_text(*colour) + " is mapped twice");
        }
        const std::string file = mapping.substr(equals + 1);
        sources += (stencil.of.empty() ? " with block " : ", block ") + std::to_string(stencil.of.size()) +
                   " = " + file;
        WEAVE_TRY(Design part, load_design(file));
        if (stencil.of.empty()) {
            design = part;
            stencil.of.push_back(part.root);
            first = file;
            continue;
        }
        // The result holds the first with all that it is; of the others only their blocks.
        if (file != first) WEAVE_CHECK_OK(keep_apart(out, file, "a design that is merged"));
        if (!same_yarns(design, part))
            warnings.push_back(file +
                               ": its yarns and feeders are not those of the first design and are left out");
        stencil.of.push_back(bring_in(design, part));
    }
    WEAVE_TRY(StencilMap map, read_map(picture, numbers, design, sources));
    for (const auto& [colour, number] : numbers) {
        if (std::find(map.blocks.begin(), map.blocks.end(), number) == map.blocks.end()) {
            warnings.push_back(picture + ": no pixel has the mapped colour " + to_text(colour));
        }
    }
    stencil.map = std::make_shared<const StencilMap>(std::move(map));
    design.title = std::filesystem::path(out).stem().string();
    put_root(design, "stencilled", std::move(stencil));
    return save_cloth(outcome, design, out, sources, warnings);
}

void add_stencil(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(
        app, outcome, "stencil",
        "Merge designs by a picture: each pixel is one stack of the design that its colour names");
    const auto picture = std::make_shared<std::string>();
    const auto mappings = std::make_shared<std::vector<std::string>>();
    const auto out = std::make_shared<std::string>();
    command
        ->add_option("IMAGE", *picture,
                     "PNG, TIFF or BMP; its bottom row is row 0 of the cloth, its left column column 0")
        ->required();
    command->add_option("--map", *mappings, "COLOUR=FILE, such as '#ff0000=twill.weave' (in quotes, or a shell takes # for a comment); once for each colour")
        ->type_name("COLOUR=FILE")
        ->required()
        ->allow_extra_args(false);
    command->add_option("-o,--out", *out, "the .weave file to write")
        ->check(output_name())
        ->type_name("FILE")
        ->required();
    on_run(command, outcome, [=, &outcome] { return make_stencil(outcome, *picture, *mappings, *out); });
}

// ---- flip

/// Tells a program which yarns stand in the way of a flip, picks and ends from 1 and from the bottom up.
/// People read it in the error.
void answer_blocked(CommandOutcome& outcome, const PlacedStack& at, std::size_t pick, std::size_t end,
                    const Error& error) {
    Json picks = Json::array(), ends = Json::array();
    for (const Slot yarn : flip(at.stack, pick - at.first_pick, end - at.first_end).in_the_way) {
        if (yarn.is_weft()) picks.push_back(at.first_pick + yarn.index() + 1);
        if (yarn.is_warp()) ends.push_back(at.first_end + yarn.index() + 1);
    }
    outcome.answer({{"picks", std::move(picks)}, {"ends", std::move(ends)}, {"error", error_json(error)}},
                   "");
}

/// The flip of this crossing, if it can be made; both from 0.
Result<Flip> flip_wished(CommandOutcome& outcome, const Design& design, std::size_t pick, std::size_t end,
                         const std::string& file) {
    const Progress progress("looking at " + file);
    Result<Outline> cloth = outline(design, CardPlace{pick, end});
    if (!cloth) return std::move(cloth).error().in(file);
    if (!cloth->at) return no_crossing(cloth->grid, pick, end).in(file);
    const PlacedStack& at = *cloth->at;
    if (Result<Stack> flipped = flip(at, pick, end); !flipped) {
        Error error = std::move(flipped).error().in(file);
        answer_blocked(outcome, at, pick, end, error);
        return error;
    }
    return Flip{pick, end, !at.stack.weft_over(pick - at.first_pick, end - at.first_end)};
}

void add_flip(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "flip",
                    "Exchange one pick and one end at their crossing: inverts one pixel of the card");
    const auto file = std::make_shared<std::string>();
    const auto out = std::make_shared<std::string>();
    const auto pick = std::make_shared<std::size_t>(0);
    const auto end = std::make_shared<std::size_t>(0);
    const CLI::Validator from_1 = between(std::size_t{1}, std::size_t{most_yarns});
    command->add_option("FILE", *file, "the .weave file")->required();
    command->add_option("--pick", *pick, "the pick, from 1")->required()->transform(from_1)->type_name("N");
    command->add_option("--end", *end, "the end, from 1")->required()->transform(from_1)->type_name("N");
    command->add_option("-o,--out", *out, "the .weave file to write")
        ->check(output_name())
        ->type_name("FILE")
        ->required();
    on_run(command, outcome, [=, &outcome]() -> Status {
        WEAVE_TRY(Design design, load_design(*file));
        WEAVE_TRY(const Flip wish, flip_wished(outcome, design, *pick - 1, *end - 1, *file));
        WEAVE_CHECK_OK(apply_edit(design, PutFlip{design.root, wish}));
        return save_cloth(outcome, design, *out, *file);
    });
}

}  // namespace

void add_make_commands(CLI::App& app, CommandOutcome& outcome) {
    add_samples(app, outcome);
    add_preset(app, outcome);
    add_slices(app, outcome);
    add_tile(app, outcome);
    add_attach(app, outcome);
    add_stencil(app, outcome);
    add_renumber(app, outcome);
    add_flip(app, outcome);
}

}  // namespace weave::program
