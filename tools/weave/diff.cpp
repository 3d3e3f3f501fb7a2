// Two designs compared in weaver's terms.

#include "command.hpp"
#include "progress.hpp"

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/diff/design_diff.hpp>
#include <weave/picture/diff_view.hpp>

#include <memory>

namespace weave::program {

namespace {

Result<WovenDesign> load_woven(const CommandOutcome& outcome, const std::string& file) {
    const Progress progress("reading " + file);
    WEAVE_TRY(Design design, load_design(file));
    Result<WovenDesign> woven = weave_design(std::move(design));
    if (!woven) return std::move(woven).error().in(file);
    note_lost_flips(outcome, woven->lost_flips, file);
    if (!woven->cloth) outcome.note(file + ": " + woven->no_cloth + "; compared without its card");
    return woven;
}

struct Comparing {
    std::string before, after, out;
};

Status run_diff(CommandOutcome& outcome, const Comparing& wish) {
    PictureFormat format = PictureFormat::png;
    if (!wish.out.empty()) {
        WEAVE_TRY(format, picture_format_of(wish.out));
        WEAVE_CHECK_OK(keep_apart(wish.out, wish.before, "a design that is read"));
        WEAVE_CHECK_OK(keep_apart(wish.out, wish.after, "a design that is read"));
    }
    WEAVE_TRY(const WovenDesign before, load_woven(outcome, wish.before));
    WEAVE_TRY(const WovenDesign after, load_woven(outcome, wish.after));
    const Progress progress("comparing " + wish.before + " and " + wish.after);
    const DesignDiff diff = diff_designs(before, after);
    if (!wish.out.empty()) {
        WEAVE_TRY(const std::string picture, draw_diff(before, after, diff, format));
        WEAVE_CHECK_OK(write_file(wish.out, picture));
    }
    Json answer = to_json(diff);
    if (!wish.out.empty()) answer["file"] = wish.out;
    outcome.answer(
        answer,
        in_words(diff, wish.before, wish.after) +
            (wish.out.empty() ? "" : "\n" + on_one_line(wish.out) + ": the cards laid on each other\n"));
    if (!diff.is_same()) outcome.found_something();
    return {};
}

}  // namespace

void add_diff_command(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "diff",
                    "Tell in what two designs differ: blocks, card, picks, ends, yarns, parameters "
                    "(exit 0: the same design, 1: they differ)");
    const auto wish = std::make_shared<Comparing>();
    command->add_option("BEFORE", wish->before, "a .weave file")->required();
    command->add_option("AFTER", wish->after, "the .weave file that is compared with it")->required();
    command
        ->add_option(
            "-o,--out", wish->out,
            "draw both cards laid on each other: .png or .svg; blue: end lifted now, orange: no longer")
        ->check(output_name())
        ->type_name("FILE");
    on_run(command, outcome, [=, &outcome] { return run_diff(outcome, *wish); });
}

}  // namespace weave::program
