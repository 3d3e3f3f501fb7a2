#include "command.hpp"

#include "progress.hpp"

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/design/outline.hpp>
#include <weave/design/pins.hpp>
#include <weave/sim/execute.hpp>
#include <weave/sim/resolution.hpp>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <set>

namespace weave::program {

namespace {

namespace fs = std::filesystem;

std::optional<double> positive(const std::string& word) {
    double value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = code == std::errc{} && end == word.data() + word.size();
    return is_number && value > 0 && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string not_positive(const std::string& word) { return "'" + word + "' is not a number above 0"; }

/// The place that a file of this name is written to: links are followed, to a file that is still missing too.
fs::path written_place(fs::path name) {
    std::error_code trouble;
    constexpr int most_links = 40;
    for (int links = 0; links < most_links && fs::is_symlink(name, trouble); ++links) {
        const fs::path target = fs::read_symlink(name, trouble);
        if (trouble) break;
        name = target.is_absolute() ? target : name.parent_path() / target;
    }
    const fs::path whole = fs::weakly_canonical(fs::absolute(name, trouble), trouble);
    return whole.empty() ? name : whole;
}

constexpr const char* reading_options[] = {"--pick-1", "--end-1", "--lifted"};

/// Digits, with or without a minus, however many.
bool is_whole(std::string_view word) {
    if (word.starts_with('-')) word.remove_prefix(1);
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

std::string lost_flip_line(const LostFlip& lost) {
    return "a flip of block '" + lost.block + "' no longer applies: " + lost.reason;
}

}  // namespace

Result<Yarns> load_cloth(const std::string& file) {
    Result<Yarns> yarns = load_yarns(file);
    std::error_code unknown;
    if (yarns || !fs::is_regular_file(file, unknown)) return yarns;
    char first = 0;
    if (std::ifstream(file) >> first && first == '{')
        return bad_input("is a design, not cloth: simulate it first (weave simulate DESIGN.weave -o CLOTH.yarns)", file);
    return yarns;
}

std::string settle_whole(std::string& word, std::int64_t low, std::int64_t high) {
    const std::optional<std::int64_t> number = parse_whole(word);
    if (!is_whole(word)) return "'" + word + "' is not a whole number";
    if (!number || *number < low || *number > high) {
        const bool has_end = high < std::numeric_limits<std::int64_t>::max();
        return "'" + word + "' is not from " + std::to_string(low) + (has_end ? " to " + std::to_string(high) : " on");
    }
    word = std::to_string(*number);
    return "";
}

CLI::Validator whole_number() {
    return between(std::int64_t{0}, std::numeric_limits<std::int64_t>::max());
}

CLI::Validator positive_number() {
    return {[](std::string& word) { return positive(word) ? "" : not_positive(word); }, ""};
}

CLI::Validator residual_goal() {
    return {[](std::string& word) -> std::string {
                const std::optional<double> goal = positive(word);
                if (!goal) return not_positive(word);
                return *goal >= sim::least_residual && *goal <= sim::most_residual ? "" : "'" + word + "' is not from 1e-15 to 1";
            },
            ""};
}

CLI::Validator output_name() {
    return {[](std::string& name) { return name.empty() ? std::string("name what is to be written") : ""; }, ""};
}

CLI::Option* add_threads(CLI::App* command, std::size_t& threads) {
    return command->add_option("--threads", threads, "processor cores to use; 0: all")
        ->transform(between(std::size_t{0}, sim::most_threads))
        ->type_name("N");
}

std::string given_of(const CLI::App* command, std::initializer_list<const char*> options) {
    for (const char* option : options) {
        if (command->count(option) > 0) return option;
    }
    return "";
}

Status keep_apart(const std::string& out, const std::string& other, const std::string& other_is) {
    if (out.empty() || other.empty()) return {};
    std::error_code unknown;
    const fs::path place = written_place(out);
    if (fs::exists(place, unknown) && !fs::is_regular_file(place, unknown)) return {};
    if (place != written_place(other)) return {};
    return Error{ErrorCode::usage, "is " + other_is + ", which would be lost; write to another file", out};
}

Status check_kind(const std::string& file, const std::string& ending) {
    static const std::set<std::string> kinds{".weave", ".yarns", ".png", ".tif", ".tiff", ".bmp", ".svg", ".pdf", ".wif", ".jc5", ".ep", ".raw", ".obj", ".vtp", ".json"};
    const std::string its = fs::path(file).extension().string();
    if (its == ending || kinds.find(its) == kinds.end()) return {};
    return Error{ErrorCode::usage, "is a name for another kind of file than what is written; name it NAME" + ending, file};
}

Status check_outputs(std::initializer_list<std::string> files) {
    for (const std::string& file : files) {
        if (!file.empty()) WEAVE_CHECK_OK(check_writable(file));
    }
    return {};
}

void note_lost_flips(const CommandOutcome& outcome, const std::vector<LostFlip>& lost_flips,
                     const std::string& file) {
    for (const LostFlip& lost : lost_flips) outcome.note(file + ": " + lost_flip_line(lost));
}

Result<Cloth> load_cloth(CommandOutcome& outcome, const std::string& file) {
    const Progress progress("reading " + file);
    WEAVE_TRY(Design design, load_design(file));
    Result<Evaluation> evaluation = evaluate(design);
    if (!evaluation) return std::move(evaluation).error().in(file);
    note_lost_flips(outcome, evaluation->lost_flips, file);
    return Cloth{std::move(design), std::move(evaluation).value()};
}

void note_stray_pin(const CommandOutcome& outcome, const Cloth& cloth, const std::string& file) {
    const Status status = check_pins(cloth.design.scene, *cloth.evaluation.block);
    if (!status) outcome.note(file + ": " + status.error().text() + "; it cannot be simulated so");
}

std::string given_reading_option(const CLI::App* command) {
    for (const char* name : reading_options) {
        if (command->count(name) > 0) return name;
    }
    return "";
}

void add_reading_options(CLI::App* command, const std::shared_ptr<BitmapReading>& reading) {
    const auto either = [&](const char* name, const char* help, const std::string& usual,
                            const std::string& other, bool BitmapReading::*member) {
        command
            ->add_option_function<std::string>(
                name,
                [reading, member, usual](const std::string& word) { (*reading).*member = word == usual; },
                std::string(help) + ": " + usual + " (if nothing is said) or " + other)
            ->check(one_of({usual, other}))
            ->type_name("WORD");
    };
    either(reading_options[0], "where the picture has pick 1", "bottom", "top",
           &BitmapReading::pick_1_at_bottom);
    either(reading_options[1], "where the picture has end 1", "left", "right", &BitmapReading::end_1_at_left);
    either(reading_options[2], "the colour of a lifted end", "black", "white",
           &BitmapReading::black_is_lifted);
}

Status save_cloth(CommandOutcome& outcome, const Design& design, const std::string& file, const std::string& sources,
                  const std::vector<std::string>& warnings) {
    WEAVE_CHECK_OK(check_kind(file, ".weave"));
    const Progress progress("weaving " + file);
    Result<Outline> woven = outline(design);
    if (!woven) {
        Error error = std::move(woven).error();
        if (error.where == "blocks." + design.root) error.where.clear();  // a block that nobody has seen yet
        return std::move(error).in(sources);
    }
    WEAVE_CHECK_OK(save_design(design, file));
    std::vector<std::string> notes = warnings;
    for (const std::string& line : warnings) outcome.note(line);
    note_lost_flips(outcome, woven->lost_flips, file);
    for (const LostFlip& lost : woven->lost_flips) notes.push_back(lost_flip_line(lost));
    const BlockGrid& grid = woven->grid;
    outcome.answer({{"file", file},
                    {"picks", grid.picks()},
                    {"ends", grid.ends()},
                    {"rows", grid.rows()},
                    {"columns", grid.columns()},
                    {"height", woven->height},
                    {"warnings", notes}},
                   on_one_line(file) + ": " + counted(grid.picks(), "pick") + " and " +
                       counted(grid.ends(), "end") + " in " + counted(grid.rows(), "row") + " and " +
                       counted(grid.columns(), "column") + ", " + std::to_string(woven->height) + " high\n");
    return {};
}

}  // namespace weave::program
