#include <studio/editors/slice_edit_canvas.hpp>

#include <QApplication>
#include <QContextMenuEvent>
#include <QKeyEvent>
#include <QMenu>
#include <QMouseEvent>

#include <algorithm>
#include <cmath>

namespace weave::studio {

SliceEditCanvas::SliceEditCanvas(QWidget* parent) : SliceCanvas(parent), m_tools(this) {
    setObjectName("slice_edit_canvas");
    setAccessibleName(tr("Drawing of the slice"));
    make_actions();
    set_tool(SliceTool::draw);
}

void SliceEditCanvas::show_slice(const Slice& slice) {
    const bool new_kind = slice.dots != m_slice.dots || m_slice.positions.empty();
    m_slice = slice;
    m_gesture.reset();
    m_marks.preview.reset();
    m_marks.dot_preview.reset();
    std::erase_if(m_marks.selected, [&](const SliceYarnId& yarn) { return !holds(m_slice, yarn); });
    if (m_marks.hovered && !holds(m_slice, *m_marks.hovered)) m_marks.hovered.reset();
    if (m_marks.path_place && *m_marks.path_place >= m_slice.positions.size()) m_marks.path_place.reset();
    set_scene(scene_of(m_slice, m_design));
    name_tools();
    if (new_kind && isVisible()) fit();
}

void SliceEditCanvas::set_design(const Design& design) {
    m_design.warp = design.warp;
    m_design.weft = design.weft;
    m_design.scene = design.scene;
    set_scene(scene_of(m_slice, m_design));
}

void SliceEditCanvas::choose(const ChosenYarns& yarns) {
    m_marks.selected = yarns;
    const bool path = yarns.size() == 1 && yarns.begin()->path;
    if (!path) m_marks.path_place.reset();
    if (path && !m_marks.path_place)
        m_marks.path_place = std::min(m_last_position, m_slice.positions.size() - 1);
    tell_chosen();
    update();
}

void SliceEditCanvas::tell_chosen() {
    if (m_marks.selected.size() != 1) return;
    QString words = told(m_slice, *m_marks.selected.begin());
    if (m_marks.path_place)
        words += tr("; ↑ ↓ move it at position %1, ← → go along it").arg(*m_marks.path_place + 1);
    Q_EMIT status(words);
}

void SliceEditCanvas::apply(Result<SliceEdit> edit, QPoint place) {
    if (!edit) return refuse(QString::fromStdString(edit.error().text()), place);
    if (edit->slice == m_slice) return;
    show_slice(edit->slice);
    choose(edit->chosen);
    if (edit->chosen.size() == 1) reveal(*edit->chosen.begin());
    Q_EMIT edited(m_slice, edit->what);
}

QString SliceEditCanvas::empty_words() const {
    if (!m_slice.positions.empty())
        return scene().paths.empty() ? tr("This slice is no cloth yet.") : QString();
    return tr("Nothing is drawn yet.\nSay above how many positions the slice has, and begin.");
}

// ---- mouse

void SliceEditCanvas::hover(QPointF place, std::optional<SliceYarnId> yarn) {
    m_marks.dot_preview.reset();
    const auto position = view().column_at(place.x(), m_slice.positions.size());
    if (position) m_last_position = *position;
    if (m_tool == SliceTool::add_dot && position && !(yarn && !yarn->path)) {
        m_marks.dot_preview =
            QPointF(static_cast<double>(*position), std::max(0.0, std::round(view().level_at(place.y()))));
        tell(tr("Click adds a %1 to position %2, level %3")
                 .arg(kind_of_dots(m_slice))
                 .arg(*position + 1)
                 .arg(m_marks.dot_preview->y() + 1));
    } else if (yarn) {
        tell(told(m_slice, *yarn));
    } else {
        tell(position ? tr("position %1").arg(*position + 1) : QString());
    }
    const bool grasp = m_tool == SliceTool::draw && yarn && yarn->path;
    const bool draws = m_tool == SliceTool::add_path || m_tool == SliceTool::add_dot;
    setCursor(grasp ? Qt::OpenHandCursor : draws ? Qt::CrossCursor : Qt::ArrowCursor);
}

void SliceEditCanvas::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return SliceCanvas::mousePressEvent(event);
    if (m_slice.positions.empty()) return;
    const QPointF place = event->position();
    const bool more = event->modifiers().testFlag(Qt::ShiftModifier);
    if (const auto position = view().column_at(place.x(), m_slice.positions.size()))
        m_last_position = *position;
    switch (m_tool) {
        case SliceTool::select:
            return select_at(place, more);
        case SliceTool::draw:
            return more ? select_at(place, more) : press_to_draw(place);
        case SliceTool::add_path:
            return begin_gesture(place, {});
        case SliceTool::add_dot:
            break;
    }
    const auto position = view().column_at(place.x(), m_slice.positions.size());
    if (!position) return refuse(tr("here is no position; Shift+Insert adds one"), place.toPoint());
    const double level = std::round(view().level_at(place.y()));
    if (level < -1 || level > static_cast<double>(scene().levels) + 2)
        return refuse(tr("that is too far from the other yarns"), place.toPoint());
    apply(add_dot_at(m_slice, *position, static_cast<std::size_t>(std::max(0.0, level))), place.toPoint());
}

void SliceEditCanvas::select_at(QPointF place, bool more) {
    const auto yarn = yarn_at(view(), scene(), place);
    if (!yarn) {
        if (!more) choose({});
        return begin_panning(place);
    }
    ChosenYarns chosen = more ? m_marks.selected : ChosenYarns{};
    m_marks.path_place.reset();
    if (more && chosen.contains(*yarn)) {
        chosen.erase(*yarn);
    } else {
        chosen.insert(*yarn);
    }
    choose(chosen);
}

void SliceEditCanvas::press_to_draw(QPointF place) {
    const auto yarn = yarn_at(view(), scene(), place);
    const auto path = path_at(view(), scene(), place);
    if (yarn && !yarn->path) return select_at(place, false);
    if (path) return begin_gesture(place, path);
    choose({});
    begin_panning(place);
}

void SliceEditCanvas::begin_gesture(QPointF place, std::optional<std::size_t> path) {
    m_gesture.emplace();
    m_gesture->path = path;
    m_gesture->begin = m_gesture->last = place;
    m_gesture->steps.resize(m_slice.positions.size());
    m_gesture->levels.assign(m_slice.positions.size(), 0);
    if (!path) return;
    for (std::size_t position = 0; position < m_slice.positions.size(); ++position) {
        const auto level = level_of(m_slice, SliceYarnId::run(*path), position);
        m_gesture->levels[position] = static_cast<double>(level.value_or(0));
    }
    m_marks.path_place.reset();
    choose({SliceYarnId::run(*path)});
}

void SliceEditCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (m_gesture && event->buttons().testFlag(Qt::LeftButton)) return lead_gesture(event->position());
    SliceCanvas::mouseMoveEvent(event);
}

/// Leads the path through every position that the pointer passed since its last place.
void SliceEditCanvas::lead_gesture(QPointF place) {
    Gesture& gesture = *m_gesture;
    if (!gesture.moved && (place - gesture.begin).manhattanLength() < QApplication::startDragDistance() / 2.0)
        return;
    gesture.moved = true;
    const double from = view().position_at(gesture.last.x()), to = view().position_at(place.x());
    const double low = view().level_at(gesture.last.y()), high = view().level_at(place.y());
    const int way = to < from ? -1 : 1;
    for (double position = std::ceil(from * way); position <= std::floor(to * way); ++position) {
        const double column = position * way;
        const double share = to == from ? 1 : (column - from) / (to - from);
        if (column >= 0 && column < static_cast<double>(m_slice.positions.size()))
            lead_to(static_cast<std::size_t>(column), low + share * (high - low));
    }
    if (const auto here = view().column_at(place.x(), m_slice.positions.size())) {
        if (std::abs(to - static_cast<double>(*here)) < 0.35) lead_to(*here, high);
        m_last_position = *here;
    }
    gesture.last = place;
    const bool whole =
        gesture.path || std::ranges::any_of(gesture.steps, [](const auto& step) { return step.has_value(); });
    if (whole) m_marks.preview = PathPreview{0, gesture.levels};
    Q_EMIT status(gesture.path
                      ? tr("Release: %1 runs so").arg(words_of(m_slice, SliceYarnId::run(*gesture.path)))
                      : tr("Release: a new %1 runs so").arg(kind_of_paths(m_slice)));
    update();
}

/// The path is to run through the gap between dots in which this level lies.
void SliceEditCanvas::lead_to(std::size_t position, double level) {
    Gesture& gesture = *m_gesture;
    const std::size_t gap = dots_below(scene(), position, level);
    const auto& places = m_slice.positions[position];
    double low = -1, high = static_cast<double>(scene().levels);  // levels of the dots on both sides
    std::size_t dots = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (!is_dot(m_slice, places[k])) continue;
        if (++dots == gap) low = static_cast<double>(k);
        if (dots == gap + 1) high = static_cast<double>(k);
    }
    const bool same = gesture.path && gap_of(m_slice, *gesture.path, position) == gap;
    const double wish = std::clamp(std::round(level), 0.0, static_cast<double>(scene().levels));
    PathStep step{position, gap, {}};
    double shown = std::clamp(level, low + 0.5, std::max(low + 0.5, high - 0.5));
    if (high - low > 1.5) shown = std::clamp(std::round(level), low + 1, high - 1);
    if (same)
        shown = static_cast<double>(level_of(m_slice, SliceYarnId::run(*gesture.path), position).value());
    if (!same) step.level = static_cast<std::size_t>(wish);
    gesture.steps[position] = step;
    const bool is_first = !gesture.path && std::ranges::count_if(gesture.steps, [](const auto& one) {
                                               return one.has_value();
                                           }) == 1;
    gesture.levels[position] = shown;
    if (is_first) std::ranges::fill(gesture.levels, shown);
    if (gesture.path) return;
    for (std::size_t after = position + 1; after < gesture.levels.size() && !gesture.steps[after]; ++after)
        gesture.levels[after] = shown;
}

void SliceEditCanvas::mouseReleaseEvent(QMouseEvent* event) {
    if (m_gesture && event->button() == Qt::LeftButton) return end_gesture(event->position());
    SliceCanvas::mouseReleaseEvent(event);
}

void SliceEditCanvas::end_gesture(QPointF place) {
    const Gesture gesture = *std::exchange(m_gesture, std::nullopt);
    m_marks.preview.reset();
    update();
    std::vector<PathStep> steps;
    for (const auto& step : gesture.steps) {
        if (step) steps.push_back(*step);
    }
    if (gesture.path && gesture.moved)
        return apply(draw_path(m_slice, *gesture.path, steps), place.toPoint());
    if (gesture.path) return;
    if (steps.empty())
        return refuse(
            tr("drag from left to right through the dots to draw a new %1").arg(kind_of_paths(m_slice)),
            place.toPoint());
    apply(draw_new_path(m_slice, steps), place.toPoint());
}

}  // namespace weave::studio
