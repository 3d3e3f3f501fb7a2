#include <weave/diff/list_diff.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>

namespace weave {

namespace {

const Json& member(const Json& object, const std::string& key) {
    static const Json absent;
    const auto found = object.find(key);
    return found == object.end() ? absent : *found;
}

std::string joined(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
}

/// Whether entries that stayed follow one another as before.
bool keep_their_order(const ListPartners& partners) {
    std::optional<std::size_t> last;
    for (std::size_t k = 0; k < partners.after(); ++k) {
        const std::size_t from = partners.of_after(k);
        if (from == ListPartners::none) continue;
        if (last && from < *last) return false;
        last = from;
    }
    return true;
}

void tell_order(const ListPartners& partners, const std::string& where, const ListWords& words,
                Changes& changes) {
    Json old = Json::array(), now = Json::array();
    for (std::size_t k = 0; k < partners.after(); ++k) {
        if (partners.of_after(k) == ListPartners::none) continue;
        old.push_back(partners.of_after(k) + 1);
        now.push_back(k + 1);
    }
    const std::string text =
        "the " + words.noun + "s stand in another order: what was " + shown(old) + " is " + shown(now);
    changes.push_back({ChangeKind::moved, where, text, std::move(old), std::move(now)});
}

}  // namespace

MemberWords words_of_member(const std::string& key) {
    static const std::map<std::string, MemberWords> words{
        {"name", {"name", ""}},
        {"colour", {"colour", ""}},
        {"radius_mm", {"radius", "mm"}},
        {"linear_density_tex", {"linear density", "tex"}},
        {"stretch_stiffness_N", {"stretch stiffness EA", "N"}},
        {"bending_stiffness_N_mm2", {"bending stiffness EI", "N mm2"}},
        {"contact_stiffness_N_mm2", {"contact stiffness", "N/mm2"}},
        {"yarn", {"number of its yarn in the list", ""}},
        {"density_ends_per_cm", {"density", "ends/cm"}},
        {"density_picks_per_cm", {"density", "rows/cm"}},
        {"ends_per_dent", {"reed", "ends a dent"}},
        {"dx_mm", {"spacing of rows", "mm"}},
        {"dy_mm", {"spacing of columns", "mm"}},
        {"dz_mm", {"spacing of levels", "mm"}},
        {"boundary_x", {"rim at the first and last row", ""}},
        {"boundary_y", {"rim at the first and last column", ""}},
        {"weft_mode", {"wefts", ""}},
        {"insertion", {"weft insertion", ""}},
        {"warp", {"warp", ""}},
        {"weft", {"weft", ""}},
        {"strain", {"target strain", ""}},
        {"stiffness_scale", {"factor on the stiffness", ""}},
        {"radius_scale", {"factor on the radius", ""}},
        {"friction", {"friction", ""}},
        {"gravity", {"gravity", ""}},
        {"centre_mm", {"centre", "mm"}},
        {"strength_N_per_mm", {"strength", "N/mm"}},
    };
    const auto found = words.find(key);
    return found == words.end() ? MemberWords{key, ""} : found->second;
}

void diff_members(const Json& before, const Json& after, const std::string& where, const std::string& subject,
                  Changes& changes) {
    const auto compare = [&](const std::string& key) {
        const Json &old = member(before, key), &now = member(after, key);
        if (old == now) return;
        const MemberWords words = words_of_member(key);
        const std::string path = joined(where, key);
        const std::string name = subject.empty() ? words.name : subject + ": " + words.name;
        if (old.is_object() && now.is_object()) return diff_members(old, now, path, name, changes);
        changes.push_back(
            {ChangeKind::changed, path, name + " " + was_and_is(old, now, words.unit), old, now});
    };
    for (auto it = after.begin(); it != after.end(); ++it) compare(it.key());
    for (auto it = before.begin(); it != before.end(); ++it) {
        if (!after.contains(it.key())) compare(it.key());
    }
}

void ListPartners::join(std::size_t before, std::size_t after) {
    m_of_before[before] = after;
    m_of_after[after] = before;
}

template <class Key>
void ListPartners::join_by(const Json& before, const Json& after, Key key) {
    std::map<std::string, std::deque<std::size_t>> waiting;
    for (std::size_t k = 0; k < m_of_before.size(); ++k) {
        if (m_of_before[k] == none) waiting[key(before[k])].push_back(k);
    }
    for (std::size_t k = 0; k < m_of_after.size(); ++k) {
        if (m_of_after[k] != none) continue;
        const auto found = waiting.find(key(after[k]));
        if (found == waiting.end() || found->second.empty()) continue;
        join(found->second.front(), k);
        found->second.pop_front();
    }
}

ListPartners::ListPartners(const Json& before, const Json& after, const ListWords& words)
    : m_of_before(before.size(), none), m_of_after(after.size(), none) {
    const std::size_t both = std::min(before.size(), after.size());
    for (std::size_t k = 0; k < both; ++k) {
        if (before[k] == after[k]) join(k, k);
    }
    const auto content = [](const Json& entry) { return canonical_json(entry); };
    const auto name = [](const Json& entry) { return entry.at("name").get<std::string>(); };
    join_by(before, after, content);
    for (std::size_t k = 0; words.has_names && k < both; ++k) {
        if (m_of_before[k] == none && m_of_after[k] == none && name(before[k]) == name(after[k])) join(k, k);
    }
    if (words.has_names) join_by(before, after, name);
    for (std::size_t k = 0; words.by_place && k < both; ++k) {
        if (m_of_before[k] == none && m_of_after[k] == none) join(k, k);
    }
}

std::string entry_in_words(const Json& list, std::size_t k, const ListWords& words) {
    const std::string text = words.noun + " " + std::to_string(k + 1);
    return words.has_names ? text + " " + in_quotes(list[k].at("name").get<std::string>()) : text;
}

void diff_list(const Json& before, const Json& after, const ListPartners& partners, const std::string& where,
               const ListWords& words, Changes& changes) {
    for (std::size_t k = 0; k < before.size(); ++k) {
        if (partners.of_before(k) != ListPartners::none) continue;
        changes.push_back(
            {ChangeKind::removed, indexed(where, k),
             entry_in_words(before, k, words) + " is gone" + (words.has_names ? "" : ": " + shown(before[k])),
             before[k], nullptr});
    }
    for (std::size_t k = 0; k < after.size(); ++k) {
        const std::size_t from = partners.of_after(k);
        const std::string place = indexed(where, k), entry = entry_in_words(after, k, words);
        if (from == ListPartners::none) {
            changes.push_back({ChangeKind::added, place,
                               entry + " is new" + (words.has_names ? "" : ": " + shown(after[k])), nullptr,
                               after[k]});
        } else if (before[from] != after[k]) {
            if (after[k].is_object())
                diff_members(before[from], after[k], place, entry, changes);
            else
                changes.push_back({ChangeKind::changed, place,
                                   entry + " " + was_and_is(before[from], after[k]), before[from], after[k]});
        }
    }
    if (!keep_their_order(partners)) tell_order(partners, where, words, changes);
}

}  // namespace weave
