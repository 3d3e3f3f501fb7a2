#pragma once

#include <weave/block/card_image.hpp>
#include <weave/core/result.hpp>
#include <weave/design/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

enum class Severity : std::uint8_t { off, info, warning, error };

/// An inclusive span of hooks, from 0.
struct HookRange {
    std::size_t first = 0, last = 0;
    friend bool operator==(const HookRange&, const HookRange&) = default;
};

/// A part of the controller's hooks, in the order in which the controller counts them.
struct HookArea {
    std::string name;
    std::size_t hooks = 0;
};

enum class HookRule : std::uint8_t { straight, point, repeats, list };

/// What the file for the controller looks like.
enum class OutputFormat : std::uint8_t { tiff, png, bmp, jc5, ep, raw };

/// How the file tells the loom which feeder a pick takes: not at all (a hand picks it), one function bit a
/// feeder, the feeder's number in function bits, one hook a feeder among the hooks, or the feeder's number in
/// hooks.
enum class FeederEncoding : std::uint8_t { none, one_hot, binary, hooks, binary_hooks };

/// What a hook does on this loom.
enum class HookUse : std::uint8_t { cast_out, body, selvedge, constant_on, feeder, regulator };

/// No loom of this library has more hooks.
inline constexpr std::size_t most_hooks = 65536;

/// Limits that validation holds a design to. Absent means: this loom does not limit it.
struct LoomLimits {
    /// Longest float on a face, in stacks that it passes: yarns that lie on each other count as one. 0: no
    /// limit.
    std::size_t float_face = 0, float_back = 0;
    std::optional<double>
        lift_difference;               ///< largest change of the share of lifted ends between picks, 0 … 1
    std::optional<double> lift_share;  ///< largest share of ends lifted on one pick, 0 … 1
    std::size_t picks = 0;             ///< most picks in one file; 0: no limit
    std::optional<double> take_up_difference;  ///< largest spread of take-up within a beam, as a share
    std::optional<double> reed_width_mm;       ///< widest cloth in the reed
};

/// One loom with its harness and controller, as one validated, versioned JSON file (see PROFILE.md beside
/// this file).
struct LoomProfile {
    std::string name, maker;
    std::string version;  ///< of this profile, as its keeper counts (member `revision`)
    std::string notes;    ///< what is known about this loom, and what is not
    Insertion insertion = Insertion::shuttle;

    std::vector<HookArea> areas;  ///< ordered; their sum is total_hooks
    std::size_t total_hooks = 0;
    HookRule hook_rule = HookRule::straight;
    std::vector<HookRange> body;           ///< hooks that carry ends, in the order of the ends
    std::size_t repeats = 1;               ///< for HookRule::repeats: how often an end's column comes again
    std::vector<std::size_t> hook_of_end;  ///< for HookRule::list
    std::vector<HookRange> cast_out, constant_on, selvedge;
    std::vector<std::string>
        selvedge_weave;  ///< one text of 0 and 1 per pick, 1 = lifted; repeats over hooks and picks

    std::size_t feeders = 1;
    FeederEncoding feeder_encoding = FeederEncoding::none;
    /// The hook of each feeder (hooks) or of each digit (binary_hooks); one_hot and binary: the function
    /// bits.
    std::vector<std::size_t> feeder_hooks;
    std::size_t feeders_per_pick = 1;
    std::vector<std::size_t> regulator_hooks;  ///< hooks that stop the take-up when lifted

    OutputFormat output = OutputFormat::tiff;
    bool lifted_is_one = true;     ///< polarity of a hook's bit in the file; in pictures: black is lifted
    bool least_bit_first = true;   ///< of the hooks in a byte
    bool pick_1_at_bottom = true;  ///< in controller files: pick 1 is the first record
    bool end_1_at_left = true;     ///< with rules other than list: end 1 takes the first body hook
    std::size_t name_limit = 8;
    std::size_t lead_in_picks = 0;   ///< empty picks before pick 1
    std::size_t function_bytes = 0;  ///< before the hooks of each pick
    bool areas_on_bytes = true;      ///< each area starts with a byte of its own
    /// Place in the file of each hook; empty: as counted.
    std::vector<std::size_t> hook_permutation;
    /// The format without public bytes, such as JC6, that the mill's CAD makes of the picture; empty: the
    /// loom takes the file as it is.
    std::string converts_to;

    std::optional<double> density_ends_per_cm;  ///< of the harness
    LoomLimits limits;
    std::map<std::string, Severity> severities;  ///< rules that this loom judges otherwise than by default

    std::string sha256;  ///< of the canonical bytes of the file that it was read from
};

/// Reads and checks a profile: every member known, ranges inside the hooks and not overlapping, body large
/// enough for at least one end. Errors name the member.
Result<LoomProfile> read_profile(std::string_view text);
Result<LoomProfile> load_profile(const std::filesystem::path& path);

/// Whether the loom's controller takes a picture, or the mill's CAD does, and not a file of hooks.
bool takes_picture(OutputFormat output);

/// The name of a format in a profile, such as `jc5`.
const std::string& name_of(OutputFormat output);

/// How many function bits or hooks the feeders of this loom need for their encoding.
std::size_t feeder_places(const LoomProfile& profile);

/// Whether hooks, not function bits, select the feeders.
bool feeders_in_hooks(const LoomProfile& profile);

std::size_t hooks_in(const std::vector<HookRange>& ranges);

/// How many ends this loom can carry: all body hooks (straight), half of them and the tip (point), their
/// share of each repeat (repeats), or as many as are listed (list).
std::size_t most_ends(const LoomProfile& profile);

/// Ends between the selvedges when a design of `ends` is on this loom: as many (straight, list), with the
/// mirror image (point), or in every repeat (repeats).
std::size_t ends_on_loom(const LoomProfile& profile, std::size_t ends);

/// The hooks (from 0) that lift end `end` of a design with `ends` ends, none where it does not fit. Where end
/// 1 is not at the left, ends count through the body from its last hook (but with list). Straight and list:
/// one. Point: the end's own and its mirror image's; the last end is the tip and stands once. Repeats: one in
/// each repeat.
std::vector<std::size_t> hooks_of_end(const LoomProfile& profile, std::size_t end, std::size_t ends);

/// What each hook is for; whatever the profile does not name is cast out.
std::vector<HookUse> hook_uses(const LoomProfile& profile);

/// Whether a selvedge hook is lifted on a pick. `place` counts the selvedge hooks from the first, `pick` from
/// 0.
bool selvedge_lifted(const LoomProfile& profile, std::size_t place, std::size_t pick);

}  // namespace weave
