#pragma once

#include <weave/design/design.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace weave {

/// A flip that no longer applies, with the reason; see FlippedBlock for what counts.
struct LostFlip {
    std::string block;
    Flip flip;
    std::string reason;
};

/// The cloth of a design.
struct Evaluation {
    BlockPtr block;
    std::vector<LostFlip> lost_flips;  ///< of the root and of all that it is made from
};

/// Turns designs into blocks, remembering every node's block. A node is computed again only when it, or a
/// block that it is made from, has changed to what is not remembered; so after an edit only what depends on
/// it is recomputed, and undoing an edit computes nothing (but after renaming: what carries, or is made from,
/// the new name). Of each name the latest 8 versions are remembered, as long as all blocks together keep
/// within a budget: beyond it the blocks that were used longest ago are forgotten, and computed again when
/// needed.
class Evaluator {
  public:
    /// Some 256 MB.
    static constexpr std::size_t standard_budget = std::size_t{1} << 26;

    /// Some 6.4 GB: three of the largest blocks.
    static constexpr std::size_t standard_limit = std::size_t{3} << 29;

    /// `budget` is what the remembered blocks may hold, in cells and slots of different stacks, 4 bytes each.
    /// The block that was used last is remembered whatever its size. `limit` is what all blocks that are at
    /// hand at once may hold while a cloth is made: those from which something is still to be made, and the
    /// one that is being made; in units of 4 bytes, see FORMAT.md.
    explicit Evaluator(std::size_t budget = standard_budget, std::size_t limit = standard_limit)
        : m_budget(budget), m_limit(limit) {}

    /// The cloth. Errors carry the place, such as `blocks.toe`; a block that does not fit within the limit
    /// is refused before it is made.
    Result<Evaluation> evaluate(const Design& design);
    /// One named block of the design.
    Result<Evaluation> evaluate(const Design& design, const std::string& block);

    /// How many nodes were computed, not remembered, since the evaluator was made.
    [[nodiscard]] std::size_t computed() const { return m_computed; }
    /// What the remembered blocks hold, in cells and slots.
    [[nodiscard]] std::size_t held() const { return m_held; }

  private:
    /// What a name stood for: a node, and the versions of the blocks that it is made from.
    struct Version {
        std::size_t id = 0;
        NodePtr node;
        std::vector<std::size_t> children;  ///< ids
        BlockPtr block;                     ///< null where it is forgotten, or was never needed
        std::size_t used = 0;               ///< when it was needed last
        std::vector<LostFlip> lost_flips;
    };
    void recognise(const std::string& name, const NodePtr& node);
    Result<BlockPtr> cloth(const std::vector<std::string>& order);
    Status make(const std::string& name, const std::vector<BlockPtr>& children);
    void touch(Version& version) { version.used = ++m_clock; }
    void forget(Version& version);
    void keep_within_budget();
    [[nodiscard]] Version& latest(const std::string& name) { return m_known.at(name).front(); }

    std::map<std::string, std::vector<Version>> m_known;  ///< of each name its versions, the latest first
    std::size_t m_budget, m_limit, m_held = 0;
    std::size_t m_computed = 0, m_last_id = 0, m_clock = 0;
};

/// Evaluates once, without remembering: each block is let go as soon as all that is made from it is made.
Result<Evaluation> evaluate(const Design& design);

}  // namespace weave
