#include <weave/io/slices_text.hpp>

#include <memory>
#include <string>
#include <utility>

namespace weave {

namespace {

/// Side by side they are nearly twice as many blocks.
constexpr std::size_t most_slices = most_blocks / 2;

/// The line without its remark and the blanks at its end.
std::string_view content_of(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const std::size_t last = line.find_last_not_of(" \t\r");
    return line.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

/// Makes the slices from `first` to before `last` one block, halves first, so that the tree stays flat: its name.
std::string lay_side_by_side(Design& design, std::vector<Slice>& slices, std::size_t first, std::size_t last) {
    std::string name = "slice-" + std::to_string(first + 1);
    NodeSource source = SliceLeaf{};
    if (last - first == 1) {
        source = SliceLeaf{std::move(slices[first])};
    } else {
        const Face face = slices[first].dots == System::weft ? Face::plus_y : Face::plus_x;
        const std::size_t middle = first + (last - first + 1) / 2;
        std::string before = lay_side_by_side(design, slices, first, middle), after = lay_side_by_side(design, slices, middle, last);
        name = "slices-" + std::to_string(first + 1) + "-to-" + std::to_string(last);
        source = AttachOperation{std::move(before), std::move(after), face};
    }
    design.blocks[name] = std::make_shared<const Node>(Node{std::move(source), {}});
    return name;
}

}  // namespace

Result<std::vector<Slice>> read_slices(std::string_view text, System dots) {
    std::vector<Slice> slices;
    bool is_between = true;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        const std::string_view line = text.substr(0, end), content = content_of(line);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (content.empty()) {
            is_between = is_between || line.find('#') == std::string_view::npos;  // a remark alone parts nothing
            continue;
        }
        auto position = parse_slice_position(content);
        if (!position) return std::move(position).error().in("line " + std::to_string(number));
        if (is_between && slices.size() == most_slices) return bad_input("there are more than " + std::to_string(most_slices) + " slices", "line " + std::to_string(number));
        if (is_between) slices.push_back({dots, {}});
        is_between = false;
        slices.back().positions.push_back(std::move(*position));
    }
    if (slices.empty()) return bad_input("holds no slice: a line such as 'T0 P0 T1 P1' for each position, a blank line between two slices");
    return slices;
}

Design design_of_slices(std::vector<Slice> slices) {
    Design design;
    const std::size_t count = slices.size();
    design.root = lay_side_by_side(design, slices, 0, count);
    return design;
}

}  // namespace weave
