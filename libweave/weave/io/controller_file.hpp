#pragma once

#include <weave/block/card_image.hpp>
#include <weave/core/result.hpp>
#include <weave/design/design.hpp>
#include <weave/loom/profile.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// Which hooks a loom lifts on which pick: one bit each, 1 = lifted, whatever the polarity of the file was.
class HookLifts {
  public:
    HookLifts() = default;
    /// None lifted.
    HookLifts(std::size_t picks, std::size_t hooks)
        : m_picks(picks), m_hooks(hooks), m_row_bytes((hooks + 7) / 8), m_bytes(picks * m_row_bytes) {}

    [[nodiscard]] std::size_t picks() const { return m_picks; }
    [[nodiscard]] std::size_t hooks() const { return m_hooks; }

    /// Both count from 0.
    [[nodiscard]] bool lifted(std::size_t pick, std::size_t hook) const {
        return (m_bytes[pick * m_row_bytes + hook / 8] >> hook % 8 & 1) != 0;
    }
    void lift(std::size_t pick, std::size_t hook) {
        std::uint8_t& byte = m_bytes[pick * m_row_bytes + hook / 8];
        byte = static_cast<std::uint8_t>(byte | 1U << hook % 8);
    }

    friend bool operator==(const HookLifts&, const HookLifts&) = default;

  private:
    std::size_t m_picks = 0, m_hooks = 0, m_row_bytes = 0;
    std::vector<std::uint8_t> m_bytes;
};

/// What a controller file says, read as one loom's profile says that it is to be read. Picks are in the order
/// in which they are woven, from 0; hooks are numbered as in the profile, from 0.
struct ControllerFile {
    OutputFormat format = OutputFormat::raw;  ///< jc5, ep or raw
    /// As the file has them, fit to be shown (on_one_line()), without the NULs that fill a field. Blanks that
    /// do are left, since they may be meant. Raw files have neither, EP files no comment.
    std::string name, comment;
    std::vector<HookArea>
        areas;  ///< as the file names them; one without a name where the format has no areas
    HookLifts lifts;
    /// The function word of each pick, bit k of it bit k mod 8 of function byte k / 8; empty where the
    /// profile has no function bytes.
    std::vector<std::uint64_t> function_words;
    std::size_t records_at = 0,
                record_bytes = 0;       ///< where the first record of the file starts, and how long each is
    bool last_pick_first = false;       ///< the first record of the file is the last pick
    std::vector<std::string> warnings;  ///< each names offset and value of what was not as observed

    [[nodiscard]] std::size_t picks() const { return lifts.picks(); }
    /// Where the record of a pick starts in the file.
    [[nodiscard]] std::size_t offset_of(std::size_t pick) const {
        return records_at + (last_pick_first ? picks() - 1 - pick : pick) * record_bytes;
    }
};

/// What kind of controller file this is, by its content or else by its name's extension (`.jc5`, `.ep`, in
/// lower case as lower_extension() gives it). Headerless raw files show no sign of what they are: they are
/// never recognised.
std::optional<OutputFormat> recognise_controller_file(std::string_view bytes, std::string_view extension);

/// Reads a file of the kind that the profile's `file.output` names: jc5, ep or raw (CONTROLLER_FILES.md
/// beside this file says what is read, byte by byte). Function bytes, areas, polarity, bit order, pick 1 and
/// hook permutation are those of the profile. Errors name the byte: a file that is cut or has bytes to spare,
/// that contradicts itself, or that is for other hooks than the profile's. A field of unknown meaning with
/// another value than the observed one is a warning.
Result<ControllerFile> read_controller_file(std::string_view bytes, const LoomProfile& profile);

/// A hook that does otherwise on a pick than the profile demands.
struct HookDifference {
    std::size_t pick = 0, hook = 0;  ///< from 0; picks of the file, lead-in included
    bool lifted = false;             ///< what the file says
    HookUse use = HookUse::cast_out;
    std::optional<std::size_t>
        end;               ///< body hooks: the end, from 0, whose other hook does otherwise; none: no end's
    bool lead_in = false;  ///< on a pick before the design's first
};
/// One line for a weaver, picks, hooks and ends counted from 1.
std::string in_words(const HookDifference& difference);

/// Of differences in hooks of one use no more are listed than this.
inline constexpr std::size_t most_listed_differences = 20;

/// The card image that a controller file makes a loom weave, and what else its hooks do.
struct ControllerCard {
    CardImage card;                  ///< without the lead-in
    std::vector<FeederSet> feeders;  ///< of each pick of the card; empty where the profile's encoding is none
    std::vector<bool> take_up;  ///< of each pick of the card; empty where the profile has no regulator hooks
    std::vector<HookDifference>
        differences;  ///< by use of the hook, then as woven; at most most_listed_differences a use
    std::size_t difference_count = 0;   ///< all of them, listed or not
    std::vector<std::string> warnings;  ///< what else the profile does not know
};

/// The card of `ends` ends (as many as the loom carries, if nothing is said) by the profile's hook places.
/// Picks after the profile's lead-in make the card; in the lead-in nothing lifts but constant-on hooks, and
/// no function bit is set. The first hook of an end decides; its others must agree. Cast-out, constant-on,
/// selvedge, regulator and further body hooks are compared with what the profile says. Errors: a file of
/// other hooks, ends that the loom cannot carry, feeders in function bits that the file does not have, a
/// feeder that the loom lacks, more than two on a pick.
Result<ControllerCard> card_of(const ControllerFile& file, const LoomProfile& profile,
                               std::optional<std::size_t> ends = {});

/// A design whose cloth is a card leaf with that card (t = p = 1), the file's name as title and its comment
/// as notes, without blanks at their end, and with the file's feeder order and take-up where it has them:
/// feeders of the loom, all with the usual yarn. Warnings: those of the file and card, and each difference.
struct DesignFromController {
    Design design;
    std::vector<std::string> warnings;
};
Result<DesignFromController> design_from_controller_file(std::string_view bytes, const LoomProfile& profile,
                                                         std::optional<std::size_t> ends = {});

}  // namespace weave
