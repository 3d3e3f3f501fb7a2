// `weave import`: a bare card image, a WIF file or a loom controller's file becomes a design.

#include "command.hpp"
#include "progress.hpp"

#include <weave/block/from_card.hpp>
#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/io/controller_file.hpp>
#include <weave/io/open_design.hpp>
#include <weave/io/wif.hpp>
#include <weave/loom/profile.hpp>

#include <algorithm>
#include <memory>
#include <optional>

namespace weave::program {

namespace {

using Counts = std::vector<std::uint32_t>;

struct ImportRequest {
    std::string in, out;
    std::string loom;                 ///< the profile, or empty
    std::optional<std::size_t> ends;  ///< of a controller file's design
    Counts t, p;
    bool infer = false;
    std::size_t grouping = 1;
    BitmapReading reading;
    std::string given_option;  ///< one of those of `reading` that was given, or empty
};

std::string in_short(const Counts& counts) {
    std::string text;
    for (std::size_t k = 0; k < std::min<std::size_t>(counts.size(), 8); ++k)
        text += (k > 0 ? "," : "") + std::to_string(counts[k]);
    return text + (counts.size() > 8 ? ",…" : "");
}

/// What was read, whatever the file was.
struct Imported {
    Design design;
    std::vector<std::string> warnings;
};

Result<Imported> design_from_bitmap(const ImportRequest& request, const std::string& bytes) {
    WEAVE_TRY(CardFromBitmap read, read_bitmap(bytes, request.reading));
    return Imported{design_of_card(std::move(read.card)), std::move(read.warnings)};
}

/// A kind of file as people write it.
std::string in_words(OutputFormat format) {
    switch (format) {
        case OutputFormat::jc5:
            return "JC5";
        case OutputFormat::ep:
            return "EP";
        case OutputFormat::raw:
            return "raw";
        case OutputFormat::tiff:
        case OutputFormat::png:
        case OutputFormat::bmp:
            break;
    }
    return "picture";
}

std::string with_article(OutputFormat format) {
    return (format == OutputFormat::ep ? "an " : "a ") + in_words(format);
}

Error usage_fault(const std::string& message, const std::string& where) {
    return {ErrorCode::usage, message, where};
}

/// The kind that the file shows must be the one that the profile describes; raw files show none, so that raw
/// is what the profile says, except of a file whose name says otherwise.
Status check_kind(const ImportRequest& request, const LoomProfile& profile, const std::string& bytes) {
    const std::string extension = lower_extension(request.in);
    const bool by_name = extension == ".jc5" || extension == ".ep";
    if (profile.output == OutputFormat::raw && !by_name) return {};
    const auto kind = recognise_controller_file(bytes, extension);
    if (!kind)
        return bad_input("is neither a JC5 nor an EP file, and the loom's profile does not say raw",
                         request.in);
    if (*kind == profile.output) return {};
    return bad_input("is " + with_article(*kind) + " file, but the profile " + request.loom +
                         " describes a loom that takes " + in_words(profile.output) + " files",
                     request.in);
}

Result<Imported> design_from_controller(const ImportRequest& request, const std::string& bytes) {
    WEAVE_TRY(const LoomProfile profile, load_profile(request.loom));
    WEAVE_CHECK_OK(check_kind(request, profile, bytes));
    Result<DesignFromController> read = design_from_controller_file(bytes, profile, request.ends);
    if (!read) return std::move(read).error().in(request.in);
    return Imported{std::move(read->design), std::move(read->warnings)};
}

Result<Imported> read_import(const ImportRequest& request) {
    WEAVE_TRY(const std::string bytes, read_file(request.in));
    const std::string extension = lower_extension(request.in);
    if (!request.loom.empty()) {
        if (!request.given_option.empty())
            return usage_fault(request.given_option + " is for pictures; the loom's profile says how to read",
                               request.in);
        return design_from_controller(request, bytes);
    }
    const bool wif = extension == ".wif" || is_wif(bytes);
    if (wif && !request.given_option.empty()) {
        return usage_fault(request.given_option + " is for pictures; WIF says itself how it is to be read",
                           request.in);
    }
    if (!wif && !is_bitmap(bytes)) {
        if (const auto kind = recognise_controller_file(bytes, extension)) {
            return usage_fault("is " + with_article(*kind) +
                                   " file, which is read as its loom's profile says: --loom LOOM.json",
                               request.in);
        }
        return bad_input(
            "is neither a PNG, TIFF or BMP picture nor a WIF file; for a loom controller's file give --loom "
            "LOOM.json",
            request.in);
    }
    if (wif) {
        Result<DesignFromWif> read = read_wif(bytes);
        if (!read) return std::move(read).error().in(request.in);
        return Imported{std::move(read->design), std::move(read->warnings)};
    }
    Result<Imported> read = design_from_bitmap(request, bytes);
    if (!read) return std::move(read).error().in(request.in);
    return read;
}

/// The leaf of the imported card with the grouping that was asked for.
Status group(const ImportRequest& request, Design& design, Json& groupings) {
    CardLeaf leaf = std::get<CardLeaf>(design.blocks.at(design.root)->source);
    if (!request.t.empty()) leaf.t = request.t;
    if (!request.p.empty()) leaf.p = request.p;
    if (request.infer) {
        const std::vector<Grouping> possible =
            possible_groupings(*leaf.card, std::max<std::size_t>(8, request.grouping));
        for (const Grouping& one : possible)
            groupings.push_back(
                {{"t", shortest_repeat(one.t)}, {"p", shortest_repeat(one.p)}, {"reason", one.reason}});
        if (request.grouping > possible.size()) {
            return Error{ErrorCode::usage, "there are only " + counted(possible.size(), "possible grouping"),
                         ""};
        }
        leaf.t = shortest_repeat(possible[request.grouping - 1].t);
        leaf.p = shortest_repeat(possible[request.grouping - 1].p);
    }
    design.blocks[design.root] = std::make_shared<const Node>(Node{std::move(leaf), {}});
    return {};
}

std::string in_words(const ImportRequest& request, const Block& block, const Json& groupings) {
    std::string words = on_one_line(request.out) + ": " + counted(block.picks(), "pick") + " and " +
                        counted(block.ends(), "end") + "\n";
    for (std::size_t k = 0; k < groupings.size(); ++k) {
        words += std::string(k + 1 == request.grouping ? "* " : "  ") + std::to_string(k + 1) +
                 ": t = " + in_short(groupings[k]["t"].get<Counts>()) +
                 "  p = " + in_short(groupings[k]["p"].get<Counts>()) + "  (" +
                 groupings[k]["reason"].get<std::string>() + ")\n";
    }
    if (!groupings.empty())
        words += "These are guesses, the best one first: a card does not tell what lies on what. Look at the cloth before you go on; another one: --infer --grouping N\n";
    if (!request.infer && request.t.empty() && request.p.empty() && request.loom.empty())
        words += "Read as one layer; where picks or ends lie on one another, --infer guesses which, or --t and --p say it.\n";
    return words;
}

Status import_design(CommandOutcome& outcome, const ImportRequest& request) {
    WEAVE_CHECK_OK(keep_apart(request.out, request.in, "the file that is read"));
    WEAVE_CHECK_OK(keep_apart(request.out, request.loom, "the loom's profile"));
    const Progress progress("reading " + request.in);
    Result<Imported> read = read_import(request);
    if (!read) return std::move(read).error();
    Design& design = read->design;
    if (design.title.empty()) design.title = std::filesystem::path(request.in).stem().string();
    Json groupings = Json::array();
    WEAVE_CHECK_OK(group(request, design, groupings));
    Result<Evaluation> cloth = evaluate(design);
    if (!cloth) return bad_input(cloth.error().message, cloth.error().where).in(request.in);
    WEAVE_CHECK_OK(save_design(design, request.out));
    for (const std::string& warning : read->warnings) outcome.note(request.in + ": " + warning);
    const Block& block = *cloth->block;
    Json json{{"file", request.out},
              {"picks", block.picks()},
              {"ends", block.ends()},
              {"warnings", read->warnings}};
    if (request.infer) json["groupings"] = groupings;
    outcome.answer(json, in_words(request, block, groupings));
    return {};
}

}  // namespace

void add_import_command(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "import",
                                    "Make a design from a card image (PNG, TIFF, BMP), a WIF file or a loom "
                                    "controller's file (JC5, EP, raw)");
    const auto request = std::make_shared<ImportRequest>();
    command->add_option("IN", request->in, "the file to read")->required();
    command->add_option("-o,--out", request->out, "the .weave file to write")
        ->check(output_name())
        ->type_name("FILE")
        ->required();
    CLI::Option* loom =
        command
            ->add_option("--loom", request->loom,
                         "the profile of the loom that a controller's file (JC5, EP, raw) is for")
            ->type_name("FILE");
    command
        ->add_option("--ends", request->ends,
                     "ends of the design in a controller's file (default: as many as the loom carries)")
        ->needs(loom)
        ->transform(between<std::size_t>(1, most_hooks))
        ->type_name("N");
    constexpr std::uint32_t most = 1 << 28;
    CLI::Option* t = add_list(command, "--t", request->t, std::uint32_t{0}, most,
                              "picks of each row, repeated over the card, such as 2,2");
    CLI::Option* p = add_list(command, "--p", request->p, std::uint32_t{0}, most,
                              "ends of each column, repeated, such as 2,2");
    CLI::Option* infer =
        command->add_flag("--infer", request->infer,
                          "guess rows and columns from the card; lists the guesses, best first, and takes the first");
    command->add_option("--grouping", request->grouping, "which of the possible groupings to take, from 1")
        ->needs(infer)
        ->transform(between(1, 1000))
        ->type_name("N");
    infer->excludes(t)->excludes(p);
    add_reading_options(command, {request, &request->reading});
    on_run(command, outcome, [=, &outcome] {
        request->given_option = given_reading_option(command);
        return import_design(outcome, *request);
    });
}

}  // namespace weave::program
