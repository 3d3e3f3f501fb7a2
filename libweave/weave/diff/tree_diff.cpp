#include <weave/diff/tree_diff.hpp>

#include <weave/core/sha256.hpp>
#include <weave/design/node_json.hpp>
#include <weave/design/tree.hpp>
#include <weave/diff/node_diff.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace weave {

namespace {

using Names = std::map<std::string, std::string>;

/// All blocks, each after those that it is made from.
std::vector<std::string> all_bottom_up(const Design& design) {
    std::vector<std::string> order;
    std::set<std::string> seen;
    for (const auto& [start, node] : design.blocks) {
        if (seen.contains(start)) continue;
        for (std::string& name : bottom_up(design, start)) {
            if (seen.insert(name).second) order.push_back(std::move(name));
        }
    }
    return order;
}

/// The blocks of one design that the other has none of this name for, each after those that it is made from.
std::vector<std::string> only_in(const Design& design, const Design& other) {
    std::vector<std::string> names = all_bottom_up(design);
    std::erase_if(names, [&](const std::string& name) { return other.blocks.contains(name); });
    return names;
}

/// A hash of a block and all that it is made from, whatever their names.
std::map<std::string, std::string> deep_hashes(const Design& design) {
    std::map<std::string, std::string> hashes;
    for (const std::string& name : all_bottom_up(design)) {
        const NodePtr& node = design.blocks.at(name);
        Names names;
        for (const std::string& child : children_of(*node)) names[child] = hashes.at(child);
        hashes[name] = sha256_hex(canonical_json(to_json(*with_renamed_children(node, names))));
    }
    return hashes;
}

/// Finds the blocks that one design has under another name.
class Renames {
  public:
    Renames(const Design& before, const Design& after)
        : m_before(before), m_after(after), m_gone(only_in(before, after)), m_fresh(only_in(after, before)) {
        if (m_gone.empty() || m_fresh.empty()) return;
        join_equal(deep_hashes(before), deep_hashes(after));
        join_made_alike();
    }

    /// From names before to names after, of the blocks that have two.
    [[nodiscard]] const Names& names() const { return m_names; }
    [[nodiscard]] bool is_taken(const std::string& after) const { return m_taken.contains(after); }

  private:
    void join(const std::string& before, const std::string& after) {
        m_names[before] = after;
        m_taken.insert(after);
    }

    void join_equal(const Names& old_hashes, const Names& now_hashes) {
        std::map<std::string, std::vector<std::string>> waiting;
        for (const std::string& name : m_fresh) waiting[now_hashes.at(name)].push_back(name);
        for (auto& [hash, names] : waiting) std::ranges::sort(names, std::greater{});
        std::vector<std::string> gone = m_gone;
        std::ranges::sort(
            gone);  // equal blocks are joined in the order of their names, whichever design is first
        for (const std::string& name : gone) {
            const auto found = waiting.find(old_hashes.at(name));
            if (found == waiting.end() || found->second.empty()) continue;
            join(name, found->second.back());
            found->second.pop_back();
        }
    }

    /// Joins what is made the same way from blocks that are known, though these may have changed.
    void join_made_alike() {
        const auto hash = [](const NodePtr& node) { return sha256_hex(canonical_json(to_json(*node))); };
        std::map<std::string, std::set<std::string>> waiting;
        for (const std::string& name : m_fresh) {
            const NodePtr& node = m_after.blocks.at(name);
            if (!is_taken(name) && !children_of(*node).empty()) waiting[hash(node)].insert(name);
        }
        for (const std::string& name : m_gone) {
            const NodePtr& node = m_before.blocks.at(name);
            if (m_names.contains(name) || children_of(*node).empty()) continue;
            const auto found = waiting.find(hash(with_renamed_children(node, m_names)));
            if (found == waiting.end() || found->second.empty()) continue;
            join(name, *found->second.begin());
            found->second.erase(found->second.begin());
        }
    }

    const Design &m_before, &m_after;
    std::vector<std::string> m_gone, m_fresh;
    Names m_names;
    std::set<std::string> m_taken;
};

/// For each block the blocks that are made from it.
std::map<std::string, std::set<std::string>> users_in(const Design& design, const Names& names) {
    const auto now = [&](const std::string& name) {
        const auto found = names.find(name);
        return found == names.end() ? name : found->second;
    };
    std::map<std::string, std::set<std::string>> users;
    for (const auto& [name, node] : design.blocks) {
        for (const std::string& child : children_of(*node)) users[now(child)].insert(now(name));
    }
    return users;
}

std::string listed(const std::set<std::string>& names) {
    std::string text;
    std::size_t shown = 0;
    for (const std::string& name : names) {
        if (++shown > 4) return text + " and " + std::to_string(names.size() - 4) + " more";
        text += (text.empty() ? "" : ", ") + in_quotes(name);
    }
    return text;
}

std::string details_in_words(const Changes& details) {
    constexpr std::size_t most = 3;
    std::string text;
    for (std::size_t k = 0; k < std::min(most, details.size()); ++k)
        text += (k > 0 ? "; " : "") + details[k].text;
    return details.size() > most ? text + "; and " + std::to_string(details.size() - most) + " more" : text;
}

class TreeComparison {
  public:
    TreeComparison(const Design& before, const Design& after)
        : m_before(before),
          m_after(after),
          m_renames(before, after),
          m_users_before(users_in(before, m_renames.names())),
          m_users_after(users_in(after, {})) {}

    TreeDiff run() {
        TreeDiff diff{m_before.root, m_after.root, name_now(m_before.root) == m_after.root, {}};
        for (const auto& [name, node] : m_before.blocks) {
            const std::string now = name_now(name);
            const auto found = m_after.blocks.find(now);
            if (found == m_after.blocks.end())
                diff.blocks.push_back({ChangeKind::removed,
                                       name,
                                       "",
                                       kind_of(*node),
                                       "",
                                       in_quotes(name) + " is gone: " + in_words(*node),
                                       {}});
            else
                compare(name, node, now, found->second, diff.blocks);
        }
        for (const auto& [name, node] : m_after.blocks) {
            if (!m_before.blocks.contains(name) && !m_renames.is_taken(name))
                diff.blocks.push_back({ChangeKind::added,
                                       "",
                                       name,
                                       "",
                                       kind_of(*node),
                                       in_quotes(name) + " is new: " + in_words(*node),
                                       {}});
        }
        return diff;
    }

  private:
    [[nodiscard]] std::string name_now(const std::string& before) const {
        const auto found = m_renames.names().find(before);
        return found == m_renames.names().end() ? before : found->second;
    }

    void compare(const std::string& name, const NodePtr& old, const std::string& now, const NodePtr& node,
                 std::vector<BlockChange>& blocks) const {
        const NodePtr renamed = with_renamed_children(old, m_renames.names());
        BlockChange change{ChangeKind::changed, name, now, kind_of(*old), kind_of(*node), "", {}};
        if (!(*renamed == *node)) change.details = diff_nodes(*renamed, *node, "blocks." + now);
        if (name != now) {
            change.kind = ChangeKind::renamed;
            change.text = in_quotes(name) + " is called " + in_quotes(now);
            if (!change.details.empty()) change.text += ", and changed: " + details_in_words(change.details);
        } else if (!change.details.empty()) {
            change.text = in_quotes(now) + ": " + details_in_words(change.details);
        } else if (has_moved(now, change.text)) {
            change.kind = ChangeKind::moved;
        } else {
            return;
        }
        blocks.push_back(std::move(change));
    }

    /// Whether a block that stayed as it was is used in other places, and in none of the former ones.
    bool has_moved(const std::string& name, std::string& text) const {
        const auto old = m_users_before.find(name), now = m_users_after.find(name);
        if (old == m_users_before.end() || now == m_users_after.end()) return false;
        const auto is_kept = [&](const std::string& user) { return now->second.contains(user); };
        if (std::ranges::any_of(old->second, is_kept)) return false;
        text = in_quotes(name) + " has moved: part of " + listed(now->second) + ", was of " +
               listed(old->second);
        return true;
    }

    const Design &m_before, &m_after;
    Renames m_renames;
    std::map<std::string, std::set<std::string>> m_users_before, m_users_after;
};

}  // namespace

TreeDiff diff_trees(const Design& before, const Design& after) {
    return TreeComparison(before, after).run();
}

}  // namespace weave
