#pragma once

#include <weave/design/design.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace weave {

/// A flip that no longer applies, with the reason.
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
/// block that it is made from, is not remembered; so after an edit only what depends on it is recomputed, and
/// undoing an edit computes nothing (but after renaming: what carries, or is made from, the new name). Of
/// each name the latest versions are remembered: up to 8, fewer of large blocks.
class Evaluator {
  public:
    /// The cloth. Errors carry the place, such as `blocks.toe`.
    Result<Evaluation> evaluate(const Design& design);
    /// One named block of the design.
    Result<Evaluation> evaluate(const Design& design, const std::string& block);

    /// How many nodes were computed, not remembered, since the evaluator was made.
    [[nodiscard]] std::size_t computed() const { return m_computed; }

  private:
    struct Known {
        NodePtr node;
        std::vector<BlockPtr> children;
        BlockPtr block;
        std::vector<LostFlip> lost_flips;
    };
    Status make_known(const std::string& name, const NodePtr& node);
    [[nodiscard]] const Known& known(const std::string& name) const { return m_known.at(name).front(); }
    std::map<std::string, std::vector<Known>> m_known;  ///< of each name its versions, the latest first
    std::size_t m_computed = 0;
};

/// Evaluates once, without remembering.
Result<Evaluation> evaluate(const Design& design);

}  // namespace weave
