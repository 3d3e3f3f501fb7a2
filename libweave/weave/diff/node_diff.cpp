#include <weave/diff/node_diff.hpp>

#include <weave/core/text.hpp>
#include <weave/diff/card_diff.hpp>
#include <weave/diff/list_diff.hpp>

#include <algorithm>
#include <functional>
#include <set>
#include <tuple>

namespace weave {

namespace {

/// Collects what differs in one node.
class Teller {
  public:
    Teller(const std::string& where, Changes& changes) : m_where(where), m_changes(changes) {}

    void tell(const std::string& member, std::string text, Json before, Json after, std::size_t count = 0) {
        m_changes.push_back({ChangeKind::changed, m_where + "." + member, std::move(text), std::move(before),
                             std::move(after), count});
    }
    /// A member that is one value: `name is …, was …`.
    void tell_value(const std::string& member, const std::string& name, const Json& before,
                    const Json& after) {
        if (before != after) tell(member, name + " " + was_and_is(before, after), before, after);
    }
    [[nodiscard]] const std::string& where() const { return m_where; }
    [[nodiscard]] Changes& changes() { return m_changes; }

  private:
    const std::string& m_where;
    Changes& m_changes;
};

/// Lines of one list that lie on lines of another: those in the same place where the lists are as long, else
/// those that are equal, and between them those in between. The other way round it is the mirror image.
LineAlignment align_by(const std::vector<std::uint64_t>& before, const std::vector<std::uint64_t>& after) {
    if (before.size() == after.size()) return matched_from_front(before.size(), after.size());
    if (before.size() > after.size()) return turned_round(align_by(after, before));
    LineAlignment lines = match_equal(before, after);
    match_gaps(lines, [&](std::size_t i, std::size_t j) { return before[i] == after[j] ? 0U : 1U; });
    return lines;
}

std::string lone_in_words(const LineAlignment& lines, const std::string& noun) {
    std::string text;
    const auto add = [&](const std::vector<LineSpan>& spans, const char* what) {
        std::vector<LineRange> ranges;
        for (const LineSpan& span : spans) ranges.push_back({span.first, span.first + span.count - 1, 1});
        if (!ranges.empty()) text += (text.empty() ? "" : ", ") + lines_in_words(noun, ranges) + " " + what;
    };
    add(lines.removed(), "removed");
    add(lines.inserted(), "inserted");
    return text;
}

/// Cells that differ in a grid of rows and columns, as far as both have them.
struct CellDiff {
    std::size_t count = 0;
    std::size_t first_row = 0, last_row = 0, first_column = 0, last_column = 0;

    void add(std::size_t row, std::size_t column) {
        if (count++ == 0) first_row = row, first_column = last_column = column;
        last_row = row;
        first_column = std::min(first_column, column);
        last_column = std::max(last_column, column);
    }
    [[nodiscard]] std::string place() const {
        return lines_in_words("row", {{first_row, last_row, 1}}) + ", " +
               lines_in_words("column", {{first_column, last_column, 1}});
    }
};

/// Compares cells whose rows and columns are laid on each other; `differs(i, j, k, l)` compares cell (i, j)
/// before with (k, l) after.
template <class Differs>
CellDiff diff_cells(const LineAlignment& rows, const LineAlignment& columns, Differs differs) {
    CellDiff diff;
    for (const LineMatch& down : rows.matches) {
        for (std::size_t r = 0; r < down.count; ++r) {
            for (const LineMatch& across : columns.matches) {
                for (std::size_t c = 0; c < across.count; ++c) {
                    if (differs(down.before + r, across.before + c, down.after + r, across.after + c))
                        diff.add(down.after + r, across.after + c);
                }
            }
        }
    }
    return diff;
}

/// Hashes of the lines of a grid; `hash(row, column)` is that of a cell. The first `common` cells of a line.
template <class Hash>
std::vector<std::uint64_t> hashes_of(std::size_t lines, std::size_t common, Hash hash) {
    std::vector<std::uint64_t> result(lines);
    for (std::size_t line = 0; line < lines; ++line) {
        for (std::size_t k = 0; k < common; ++k)
            result[line] = (result[line] ^ hash(line, k)) * 0x9e3779b97f4a7c15 + 1;
    }
    return result;
}

/// Lays two grids on each other, rows by their first columns and columns by their first rows.
template <class HashBefore, class HashAfter>
std::pair<LineAlignment, LineAlignment> align_grids(std::pair<std::size_t, std::size_t> before,
                                                    std::pair<std::size_t, std::size_t> after,
                                                    HashBefore hash_before, HashAfter hash_after) {
    const std::size_t rows = std::min(before.first, after.first),
                      columns = std::min(before.second, after.second);
    const auto turned = [](const auto& hash) {
        return [&](std::size_t column, std::size_t row) { return hash(row, column); };
    };
    return {
        align_by(hashes_of(before.first, columns, hash_before), hashes_of(after.first, columns, hash_after)),
        align_by(hashes_of(before.second, rows, turned(hash_before)),
                 hashes_of(after.second, rows, turned(hash_after)))};
}

void tell_grid(const std::pair<LineAlignment, LineAlignment>& grid, const CellDiff& cells,
               const std::string& member, const std::string& noun, Teller& teller) {
    const auto& [rows, columns] = grid;
    std::string text = lone_in_words(rows, "row");
    if (const std::string more = lone_in_words(columns, "column"); !more.empty())
        text += (text.empty() ? "" : ", ") + more;
    if (cells.count > 0)
        text += (text.empty() ? "" : ", ") + counted(cells.count, noun) + " differ in " + cells.place();
    if (text.empty()) return;
    const auto size = [](std::size_t r, std::size_t c) { return Json{{"rows", r}, {"columns", c}}; };
    teller.tell(member, text, size(rows.before, columns.before), size(rows.after, columns.after),
                cells.count);
}

void tell_source(const StacksLeaf& before, const StacksLeaf& after, Teller& teller) {
    const Block &old = *before.block, &now = *after.block;
    const auto hash_of = [](const Block& block) {
        std::vector<std::uint64_t> table;
        for (const Stack& stack : block.stacks()) table.push_back(StackHash()(stack));
        return
            [&block, table](std::size_t row, std::size_t column) { return table[block.cells(row)[column]]; };
    };
    const auto grid =
        align_grids({old.rows(), old.columns()}, {now.rows(), now.columns()}, hash_of(old), hash_of(now));
    const CellDiff cells =
        diff_cells(grid.first, grid.second, [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
            return old.stack(i, j) != now.stack(k, l);
        });
    tell_grid(grid, cells, "stacks", "stack", teller);
    teller.tell_value("height", "height", old.height(), now.height());
}

void tell_source(const CardLeaf& before, const CardLeaf& after, Teller& teller) {
    const auto size = [](const CardImage& card) {
        return Json{{"picks", card.picks()}, {"ends", card.ends()}};
    };
    if (*before.card != *after.card) {
        const CardDiff diff = diff_cards(*before.card, *after.card);
        std::string text = lone_in_words(diff.alignment.picks, "pick");
        if (const std::string ends = lone_in_words(diff.alignment.ends, "end"); !ends.empty())
            text += (text.empty() ? "" : ", ") + ends;
        if (diff.changed() > 0)
            text += (text.empty() ? "" : ", ") + counted(diff.changed(), "crossing") + " of the card differ";
        teller.tell("card", text, size(*before.card), size(*after.card), diff.changed());
    }
    teller.tell_value("t", "picks a row", before.t, after.t);
    teller.tell_value("p", "ends a column", before.p, after.p);
}

void tell_source(const PresetLeaf& before, const PresetLeaf& after, Teller& teller) {
    teller.tell_value("family", "preset", before.preset.family, after.preset.family);
    diff_members(Json(before.preset.options), Json(after.preset.options), teller.where() + ".options",
                 "option", teller.changes());
}

void tell_source(const SliceLeaf& before, const SliceLeaf& after, Teller& teller) {
    if (before.slice.dots != after.slice.dots) {
        const auto kind = [](const Slice& slice) { return slice.dots == System::weft ? "weft" : "warp"; };
        teller.tell_value("dots", "dots", kind(before.slice), kind(after.slice));
    }
    const auto texts = [](const Slice& slice) {
        std::vector<std::string> list;
        for (const auto& position : slice.positions) list.push_back(to_text(position));
        return list;
    };
    const std::vector<std::string> old = texts(before.slice), now = texts(after.slice);
    std::vector<std::uint64_t> old_hashes, now_hashes;
    for (const std::string& text : old) old_hashes.push_back(std::hash<std::string>()(text));
    for (const std::string& text : now) now_hashes.push_back(std::hash<std::string>()(text));
    for (const MergedSpan& span : merged(align_by(old_hashes, now_hashes))) {
        for (std::size_t k = 0; k < span.count; ++k) {
            const bool gone = span.kind == MergedSpan::Kind::removed,
                       is_new = span.kind == MergedSpan::Kind::inserted;
            const Json was = is_new ? Json() : Json(old[span.before + k]),
                       is = gone ? Json() : Json(now[span.after + k]);
            const std::size_t number = (gone ? span.before : span.after) + k;
            teller.tell_value(indexed("positions", number), "position " + std::to_string(number + 1), was,
                              is);
        }
    }
}

void tell_source(const TileOperation& before, const TileOperation& after, Teller& teller) {
    teller.tell_value("of", "repeats", before.of, after.of);
    teller.tell_value("x", "repeats along the warp", before.x, after.x);
    teller.tell_value("y", "repeats along the weft", before.y, after.y);
    teller.tell_value("z", "repeats in height", before.z, after.z);
}

void tell_source(const AttachOperation& before, const AttachOperation& after, Teller& teller) {
    const auto face = [](Face value) { return face_names()[static_cast<std::size_t>(value)]; };
    teller.tell_value("of", "attached to", before.of, after.of);
    teller.tell_value("other", "what is attached", before.other, after.other);
    teller.tell_value("face", "face", face(before.face), face(after.face));
}

void tell_source(const StencilOperation& before, const StencilOperation& after, Teller& teller) {
    teller.tell_value("of", "list of blocks", before.of, after.of);
    if (*before.map == *after.map) return;
    const StencilMap &old = *before.map, &now = *after.map;
    // By the names that the map stands for: the list may number the same blocks otherwise.
    const auto name = [](const StencilOperation& stencil, std::size_t row,
                         std::size_t column) -> const std::string& {
        return stencil.of[stencil.map->row(row)[column]];
    };
    const auto hash_of = [](const StencilOperation& stencil) {
        std::vector<std::uint64_t> table;
        for (const std::string& block : stencil.of) table.push_back(std::hash<std::string>()(block));
        return [&stencil, table](std::size_t row, std::size_t column) {
            return table[stencil.map->row(row)[column]];
        };
    };
    const auto grid =
        align_grids({old.rows, old.columns}, {now.rows, now.columns}, hash_of(before), hash_of(after));
    const CellDiff cells =
        diff_cells(grid.first, grid.second, [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
            return name(before, i, j) != name(after, k, l);
        });
    const std::size_t so_far = teller.changes().size();
    tell_grid(grid, cells, "map", "place", teller);
    if (teller.changes().size() == so_far && before.of == after.of)
        teller.tell("map", "the map names the same blocks by other numbers", nullptr, nullptr);
}

void tell_source(const RenumberOperation& before, const RenumberOperation& after, Teller& teller) {
    const auto line = [](const RenumberOperation& renumber) {
        return std::string(renumber.system == System::weft ? "row " : "column ") +
               std::to_string(renumber.line + 1);
    };
    const auto from_one = [](const RenumberOperation& renumber) {
        Json list = Json::array();
        for (const std::size_t number : renumber.order) list.push_back(number + 1);
        return list;
    };
    teller.tell_value("of", "renumbers", before.of, after.of);
    teller.tell_value(after.system == System::weft ? "row" : "column", "renumbered line", line(before),
                      line(after));
    teller.tell_value("order", "order", from_one(before), from_one(after));
}

bool comes_before(const Flip& a, const Flip& b) {
    return std::tie(a.pick, a.end, a.weft_over) < std::tie(b.pick, b.end, b.weft_over);
}

/// The flips of one list that another lacks, each as often as it lacks it.
std::vector<Flip> lacking(std::vector<Flip> from, std::vector<Flip> in) {
    std::vector<Flip> rest;
    std::ranges::sort(from, comes_before);
    std::ranges::sort(in, comes_before);
    std::ranges::set_difference(from, in, std::back_inserter(rest), comes_before);
    return rest;
}

Json flips_json(const std::vector<Flip>& flips) {
    Json list = Json::array();
    for (const Flip& flip : flips) {
        if (list.size() == most_listed) break;
        list.push_back(
            {{"pick", flip.pick + 1}, {"end", flip.end + 1}, {"weft", flip.weft_over ? "over" : "under"}});
    }
    return list;
}

void tell_flips(const std::vector<Flip>& flips, bool is_new, Teller& teller) {
    if (flips.empty()) return;
    constexpr std::size_t most = 4;
    std::string text = counted(flips.size(), "flip") + (is_new ? " more" : " fewer");
    for (std::size_t k = 0; k < std::min(most, flips.size()); ++k)
        text += (k == 0 ? " (" : "; ") + in_words(flips[k]);
    text += flips.size() > most ? " ...)" : ")";
    const Json list = flips_json(flips);
    teller.tell("flips", text, is_new ? Json() : list, is_new ? list : Json(), flips.size());
    teller.changes().back().kind = is_new ? ChangeKind::added : ChangeKind::removed;
}

/// A list without these flips, the last ones of equal ones taken out, as it stands.
std::vector<Flip> without(const std::vector<Flip>& list, const std::vector<Flip>& flips) {
    std::multiset<Flip, decltype(&comes_before)> out(flips.begin(), flips.end(), &comes_before);
    std::vector<Flip> rest;
    for (auto flip = list.rbegin(); flip != list.rend(); ++flip) {
        const auto found = out.find(*flip);
        if (found == out.end())
            rest.push_back(*flip);
        else
            out.erase(found);
    }
    std::ranges::reverse(rest);
    return rest;
}

void diff_flips(const std::vector<Flip>& before, const std::vector<Flip>& after, Teller& teller) {
    if (before == after) return;
    const std::vector<Flip> gone = lacking(before, after), fresh = lacking(after, before);
    tell_flips(gone, false, teller);
    tell_flips(fresh, true, teller);
    const std::vector<Flip> kept = without(before, gone), kept_now = without(after, fresh);
    const bool fresh_are_last = std::equal(kept_now.begin(), kept_now.end(), after.begin());
    const bool gone_were_last = std::equal(kept.begin(), kept.end(), before.begin());
    if (kept != kept_now || !fresh_are_last || !gone_were_last)
        teller.tell(
            "flips",
            "flips are made in another order: new ones not after the others, or the others not as before",
            flips_json(before), flips_json(after));
}

}  // namespace

Changes diff_nodes(const Node& before, const Node& after, const std::string& where) {
    Changes changes;
    Teller teller(where, changes);
    if (before.source.index() != after.source.index()) {
        teller.tell("kind", "is " + in_words(after) + "; was " + in_words(before), kind_of(before),
                    kind_of(after));
    } else {
        std::visit(
            [&](const auto& now) {
                using Source = std::decay_t<decltype(now)>;
                tell_source(std::get<Source>(before.source), now, teller);
            },
            after.source);
    }
    diff_flips(before.flips, after.flips, teller);
    return changes;
}

}  // namespace weave
