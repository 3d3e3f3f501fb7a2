#pragma once

#include <weave/command/command.hpp>
#include <weave/core/json.hpp>
#include <weave/core/text.hpp>
#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/picture/picture.hpp>
#include <weave/sim/yarns.hpp>

#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

namespace weave::program {

/// What is wrong with a word that is to be a whole number within these limits, in decimal digits; empty where it
/// is one. It is written anew, so that a 0 in front does not make it octal.
std::string settle_whole(std::string& word, std::int64_t low, std::int64_t high);

/// A whole number within limits, to be used with transform(). The limits stay out of the help, where only the
/// meaning of a number counts.
template <class Whole>
CLI::Validator between(Whole low, Whole high) {
    return {[low = static_cast<std::int64_t>(low), high = static_cast<std::int64_t>(high)](std::string& word) {
                return settle_whole(word, low, high);
            },
            ""};
}

/// A whole number from 0 on, to be used with transform().
CLI::Validator whole_number();

/// A number above 0 in decimal digits, such as 0.5 or 1e-6.
CLI::Validator positive_number();

/// A residual to relax to (sim/resolution.hpp has its limits).
CLI::Validator residual_goal();

/// The name of what is to be written, which must not be empty.
CLI::Validator output_name();

/// Adds `--threads`, of which 0 means one a core.
CLI::Option* add_threads(CLI::App* command, std::size_t& threads);

/// The first of these options that was given, such as `--lifted`; empty if none was.
std::string given_of(const CLI::App* command, std::initializer_list<const char*> options);

/// Refuses to write `out` over `other`, by whatever names and links both go. `other_is` says in words what would be lost,
/// such as `the design that is read`. Devices and pipes are not overwritten; an empty name is no file.
Status keep_apart(const std::string& out, const std::string& other, const std::string& other_is);

/// Whether these files can be written, as far as that shows beforehand: for what comes after long work. An empty name is no file.
Status check_outputs(std::initializer_list<std::string> files);
/// A file that is written under the ending of another kind would be taken for one: `ending` such as `.weave`.
Status check_kind(const std::string& file, const std::string& ending);

/// An option that is a list such as 1,0,2: whole numbers within limits, none of them left out. `list` must outlive
/// the command.
template <class Whole>
CLI::Option* add_list(CLI::App* command, const std::string& name, std::vector<Whole>& list, Whole low, Whole high,
                      const std::string& help) {
    const auto read = [&list, name, low, high](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            for (std::string& word : CLI::detail::split(text + ' ', ',')) {  // or nothing after the last comma is lost
                CLI::detail::trim(word);
                const std::string trouble =
                    settle_whole(word, static_cast<std::int64_t>(low), static_cast<std::int64_t>(high));
                if (!trouble.empty()) throw CLI::ValidationError(name, trouble);
                list.push_back(static_cast<Whole>(*parse_whole(word)));
            }
        }
    };
    return command->add_option_function<std::vector<std::string>>(name, read, help)
        ->allow_extra_args(false)
        ->type_name("N,N,");
}

/// A design from a file, and its cloth. Lost flips are told on standard error.
struct Cloth {
    Design design;
    Evaluation evaluation;
};
Result<Cloth> load_cloth(CommandOutcome& outcome, const std::string& file);

/// Tells on standard error of the flips in `file` that no longer apply.
void note_lost_flips(const CommandOutcome& outcome, const std::vector<LostFlip>& lost_flips,
                     const std::string& file);

/// Tells on standard error where the scene pins a yarn that the cloth does not have.
void note_stray_pin(const CommandOutcome& outcome, const Cloth& cloth, const std::string& file);

/// Checks that a new design evaluates, saves it, and tells what came out. `sources` names what it was made
/// from: that is where a person looks when it does not fit together.
Status save_cloth(CommandOutcome& outcome, const Design& design, const std::string& file, const std::string& sources,
                  const std::vector<std::string>& warnings = {});

/// Relaxed yarns from a file.
Result<Yarns> load_yarns(const std::string& file);

/// The same for what looks at cloth. Errors: a design, which has to be simulated first, is told as one.
Result<Yarns> load_cloth(const std::string& file);

/// What the name of a picture ends in; an error (usage) where that is neither .png nor .svg.
Result<PictureFormat> picture_format_of(const std::string& file);

/// The first of the options below that was given, such as `--lifted`; empty if none was.
std::string given_reading_option(const CLI::App* command);

/// Options that say how a bilevel picture stands for a card; `reading` must outlive the command.
void add_reading_options(CLI::App* command, const std::shared_ptr<BitmapReading>& reading);

/// The work of each group of commands.
void add_make_commands(CLI::App& app,
                       CommandOutcome& outcome);  // samples, preset, tile, attach, stencil, renumber, flip
void add_import_command(CLI::App& app, CommandOutcome& outcome);       // import
void add_look_commands(CLI::App& app, CommandOutcome& outcome);        // info, card, render
void add_diff_command(CLI::App& app, CommandOutcome& outcome);         // diff
void add_loom_commands(CLI::App& app, CommandOutcome& outcome);        // check, export
void add_simulation_commands(CLI::App& app, CommandOutcome& outcome);  // simulate, export-yarns
void add_inspection_commands(CLI::App& app, CommandOutcome& outcome);  // inspect, compare
void add_job_commands(CLI::App& app, CommandOutcome& outcome);         // jobs
void add_session_commands(CLI::App& app, CommandOutcome& outcome);     // sessions
void add_bench_commands(CLI::App& app, CommandOutcome& outcome);       // bench
void add_device_commands(CLI::App& app, CommandOutcome& outcome);      // devices

}  // namespace weave::program
