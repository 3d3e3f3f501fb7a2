#include <studio/editors/slice_scene.hpp>

#include <weave/picture/page.hpp>

#include <algorithm>
#include <map>

namespace weave::studio {

namespace {

constexpr SliceLimits no_limits{most_yarns, most_height};

/// What the library lays out, as a scene. Ids are left to the caller.
SliceScene from_map(const SliceMap& map) {
    SliceScene scene;
    scene.dots = map.dots;
    scene.begin = map.begin;
    scene.positions = map.positions;
    scene.all_positions = map.all_positions;
    scene.levels = map.levels;
    for (const SliceDot& dot : map.dot_list) {
        const SliceYarnId yarn = SliceYarnId::dot(map.begin + dot.position, 0);
        scene.dot_list.push_back({yarn, dot.level, dot.number, to_qt(dot.colour), dot.loose});
    }
    for (const SlicePath& path : map.paths) {
        ScenePath shown;
        shown.number = path.number;
        shown.colour = to_qt(path.colour);
        shown.first = map.begin + path.first;
        shown.levels = path.levels;
        shown.loose = path.loose;
        shown.shift = path.shift;
        shown.leftwards = path.leftwards;
        shown.reaches_left = reaches(map, path, Side::left);
        shown.reaches_right = reaches(map, path, Side::right);
        shown.woven_first = shown.first;
        shown.woven_last = shown.last();
        if (map.dots == System::warp) {
            for (const std::size_t place : arrow_places(map, path, false))
                shown.arrows.push_back(shown.first + place);
        }
        scene.paths.push_back(std::move(shown));
    }
    for (const SliceTurn& turn : map.turns) {
        scene.turns.push_back({turn.turn.side == Side::right, turn.caught(), turn.from, turn.to,
                               turn.from ? turn.turn.to_pick : turn.turn.from_pick});
    }
    return scene;
}

PictureRequest request_of(System dots, std::size_t line, std::size_t begin) {
    PictureRequest request;
    request.view = dots == System::weft ? View::warp_slice : View::weft_slice;
    request.line = line;
    (dots == System::weft ? request.first_row : request.first_column) = begin;
    return request;
}

/// The way of a path through the whole drawing, of which the cloth may hold only a part.
void draw_whole(const Slice& slice, ScenePath& path) {
    path.first = 0;
    path.levels.clear();
    path.loose.clear();
    for (std::size_t position = 0; position < slice.positions.size(); ++position) {
        const std::size_t level = level_of(slice, path.yarn, position).value();
        path.levels.push_back(level);
        path.loose.push_back(slice.positions[position][level].yarn.is_loose());
    }
}

void add_paths(const Slice& slice, SliceScene& scene) {
    const SliceNumbers numbers = card_numbers(slice);
    std::vector<std::optional<std::size_t>> yarn_of(numbers.paths.size());  // by number on the card
    for (std::size_t k = 0; k < numbers.paths.size(); ++k) {
        if (numbers.paths[k]) yarn_of[*numbers.paths[k]] = k;
    }
    std::vector<bool> shown(numbers.paths.size());
    for (ScenePath& path : scene.paths) {
        path.yarn = SliceYarnId::run(yarn_of.at(path.number.value()).value());
        shown[path.yarn.number] = true;
        draw_whole(slice, path);
    }
    for (std::size_t k = 0; k < shown.size(); ++k) {
        if (shown[k]) continue;
        ScenePath path;
        path.yarn = SliceYarnId::run(k);
        path.number = numbers.paths[k];
        path.colour = to_qt(scene.wefts_run() ? paper_weft : paper_warp);
        draw_whole(slice, path);
        path.woven_first = 1, path.woven_last = 0;
        scene.paths.push_back(std::move(path));
    }
    for (ScenePath& path : scene.paths) {
        path.shift = (static_cast<double>(path.yarn.number) + 0.5) / static_cast<double>(shown.size()) - 0.5;
    }
}

void add_dots(const Slice& slice, SliceScene& scene) {
    const SliceNumbers numbers = card_numbers(slice);
    std::map<std::pair<std::size_t, std::size_t>, SceneDot> shown;  // by position and level
    for (SceneDot& dot : scene.dot_list) shown[{dot.yarn.position, dot.level}] = dot;
    scene.dot_list.clear();
    for (std::size_t position = 0; position < slice.positions.size(); ++position) {
        const auto& places = slice.positions[position];
        for (std::size_t level = 0; level < places.size(); ++level) {
            if (!is_dot(slice, places[level])) continue;
            const SliceYarnId yarn = SliceYarnId::dot(position, places[level].yarn.index());
            SceneDot dot{yarn,
                         level,
                         {},
                         to_qt(scene.wefts_run() ? paper_warp : paper_weft),
                         places[level].yarn.is_loose()};
            if (const auto found = shown.find({position, level}); found != shown.end()) dot = found->second;
            dot.yarn = yarn;
            dot.number = numbers.of(yarn);
            scene.dot_list.push_back(dot);
        }
    }
}

}  // namespace

QColor to_qt(Colour colour) {
    return {colour.red, colour.green, colour.blue};
}

SliceScene scene_of(const Slice& slice, const Design& design) {
    const Result<Block> block = to_block(slice);
    if (!block) {
        SliceScene empty;
        empty.dots = slice.dots;
        empty.positions = empty.all_positions = slice.positions.size();
        return empty;
    }
    const Subject subject{design, *block, request_of(slice.dots, 0, 0)};
    const YarnColours colours(subject);
    SliceScene scene = from_map(slice_map(subject, colours, WeftRuns(subject, colours), no_limits));
    add_paths(slice, scene);
    add_dots(slice, scene);
    scene.levels = std::max(scene.levels, levels_of(slice));
    return scene;
}

BlockSlices::BlockSlices(const Design& design, BlockPtr block)
    : m_design(design),
      m_block(std::move(block)),
      m_subject{m_design, *m_block, {}},
      m_colours(m_subject),
      m_runs(m_subject, m_colours) {}

std::size_t BlockSlices::positions(System dots) const {
    return dots == System::weft ? m_block->rows() : m_block->columns();
}

std::size_t BlockSlices::lines(System dots) const {
    return dots == System::weft ? m_block->columns() : m_block->rows();
}

SliceScene BlockSlices::part(System dots, std::size_t line, std::size_t begin, std::size_t count) const {
    const Subject subject{m_design, *m_block, request_of(dots, line, begin)};
    SliceScene scene = from_map(slice_map(subject, m_colours, m_runs, {count, most_height}));
    const bool rows = dots == System::weft;
    for (SceneDot& dot : scene.dot_list) {
        const std::size_t position = dot.yarn.position;
        dot.yarn.number = *dot.number - (rows ? m_block->first_pick(position) : m_block->first_end(position));
    }
    const std::size_t first = rows ? m_block->first_end(line) : m_block->first_pick(line);
    for (ScenePath& path : scene.paths) path.yarn = SliceYarnId::run(*path.number - first);
    return scene;
}

}  // namespace weave::studio
