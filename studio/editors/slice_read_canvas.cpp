#include <studio/editors/slice_read_canvas.hpp>

#include <studio/editors/own_keys.hpp>

#include <weave/block/flip.hpp>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>

#include <algorithm>
#include <cmath>

namespace weave::studio {

SliceReadCanvas::SliceReadCanvas(QWidget* parent) : SliceCanvas(parent) {
    setObjectName("slice_read_canvas");
    setAccessibleName(tr("Slice through the block"));
}

void SliceReadCanvas::show_slices(std::shared_ptr<const BlockSlices> slices, System dots, std::size_t line) {
    const bool other =
        !m_slices || !slices || dots != m_dots || m_slices->positions(dots) != slices->positions(dots);
    m_slices = std::move(slices);
    if (other || line != m_line) m_marks = {};
    m_dots = dots;
    m_line = line;
    lay_out();
    if (other && m_slices && isVisible()) fit();
    update();
}

void SliceReadCanvas::set_line(System dots, std::size_t line) {
    show_slices(m_slices, dots, line);
}

void SliceReadCanvas::show_crossing(std::size_t pick, std::size_t end) {
    if (!m_slices || pick >= m_slices->block().picks() || end >= m_slices->block().ends()) return;
    const bool weft_dots = m_dots == System::weft;
    centre_on(weft_dots ? m_slices->block().row_of_pick(pick) : m_slices->block().column_of_end(end));
    const auto dot = std::ranges::find(scene().dot_list, weft_dots ? pick : end, &SceneDot::number);
    const auto path = std::ranges::find(scene().paths, weft_dots ? end : pick, &ScenePath::number);
    if (dot == scene().dot_list.end() || path == scene().paths.end()) return;
    m_marks.crossing = {dot->yarn, path->yarn};
    update();
}

QString SliceReadCanvas::empty_words() const {
    return m_slices ? QString() : tr("The block is being read …");
}

/// What is seen, and a screen's share on both sides, so that moving a little lays out nothing.
void SliceReadCanvas::lay_out() {
    if (!m_slices) return set_scene({});
    if (scene().all_positions == 0 || scene().dots != m_dots) {  // the view cannot tell yet what is seen
        SliceScene first = m_slices->part(m_dots, m_line, 0, 1);
        set_scene(std::move(first));
    }
    const auto [from, count] = seen();
    const std::size_t begin = from - std::min<std::size_t>(from, 8);
    set_scene(m_slices->part(m_dots, m_line, begin, count + 16));
}

std::optional<SliceReadCanvas::Crossing> SliceReadCanvas::crossing_of(const SceneDot& dot,
                                                                      const ScenePath& path) const {
    if (!dot.number || !path.number) return {};
    const bool weft_dots = m_dots == System::weft;
    return Crossing{&dot, &path, weft_dots ? *dot.number : *path.number,
                    weft_dots ? *path.number : *dot.number};
}

std::optional<SliceReadCanvas::Crossing> SliceReadCanvas::crossing_at(QPointF place) const {
    const auto position = view().column_at(place.x(), scene().all_positions);
    if (!position) return {};
    const double level = view().level_at(place.y());
    const auto away = [&](std::size_t other) { return std::abs(static_cast<double>(other) - level); };
    const SceneDot* dot = nullptr;
    for (const SceneDot& one : scene().dot_list) {
        if (one.yarn.position == *position && away(one.level) < 1.3 &&
            (dot == nullptr || away(one.level) < away(dot->level)))
            dot = &one;
    }
    if (dot == nullptr) return {};
    const ScenePath* path = nullptr;
    const auto between = [&](const ScenePath& one) {  // from the pointer, so that its side of the dot counts
        return away(*one.level_at(*position));
    };
    for (const ScenePath& one : scene().paths) {
        if (!one.level_at(*position) || one.woven_first > one.woven_last) continue;
        if (path == nullptr || between(one) < between(*path)) path = &one;
    }
    return path == nullptr ? std::nullopt : crossing_of(*dot, *path);
}

QString SliceReadCanvas::words_of(const Crossing& crossing) const {
    const bool over = m_slices->block().weft_over(crossing.pick, crossing.end);
    const QString words = over ? tr("pick %1 lies over end %2; a click lifts the end")
                               : tr("end %2 is lifted over pick %1; a click lays the pick over it");
    return words.arg(crossing.pick + 1).arg(crossing.end + 1);
}

void SliceReadCanvas::hover(QPointF place, std::optional<SliceYarnId> yarn) {
    m_marks.crossing.reset();
    if (!m_slices) return;
    const auto crossing = crossing_at(place);
    setCursor(crossing ? Qt::PointingHandCursor : Qt::ArrowCursor);
    if (crossing) {
        m_marks.crossing = {crossing->dot->yarn, crossing->path->yarn};
        tell(words_of(*crossing));
    } else if (yarn && yarn->path) {
        const ScenePath* path = path_of(scene(), yarn->number);
        const QString words = m_dots == System::weft ? tr("end %1") : tr("pick %1");
        tell(path != nullptr && path->number ? words.arg(*path->number + 1) : QString());
    } else {
        tell({});
    }
}

void SliceReadCanvas::ask_flip(const Crossing& crossing, QPoint place) {
    const PlacedStack at = stack_at(m_slices->block(), crossing.pick, crossing.end);
    if (const auto flipped = flip(at, crossing.pick, crossing.end); !flipped)
        return refuse(QString::fromStdString(flipped.error().text()), place);
    Q_EMIT flip_wanted(crossing.pick, crossing.end);
}

void SliceReadCanvas::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return SliceCanvas::mousePressEvent(event);
    m_pressed = event->position();
}

void SliceReadCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (m_pressed && !is_panning() &&
        (event->position() - *m_pressed).manhattanLength() >= QApplication::startDragDistance())
        begin_panning(*m_pressed);
    SliceCanvas::mouseMoveEvent(event);
}

void SliceReadCanvas::mouseReleaseEvent(QMouseEvent* event) {
    const bool click = m_pressed && !is_panning() && event->button() == Qt::LeftButton;
    m_pressed.reset();
    SliceCanvas::mouseReleaseEvent(event);
    if (!click || !m_slices) return;
    if (const auto crossing = crossing_at(event->position())) {
        ask_flip(*crossing, event->position().toPoint());
    } else if (view().column_at(event->position().x(), scene().all_positions)) {
        refuse(tr("no two yarns cross here; click on a dot"), event->position().toPoint());
    }
}

/// The crossing that keys have chosen goes to the next dot, or to the next path.
void SliceReadCanvas::step(int along, int up) {
    if (!m_slices || scene().dot_list.empty() || scene().paths.empty()) return;
    std::vector<const SceneDot*> dots;
    for (const SceneDot& dot : scene().dot_list) dots.push_back(&dot);
    const SceneDot* dot = m_marks.crossing ? dot_of(scene(), m_marks.crossing->first) : nullptr;
    const ScenePath* path = m_marks.crossing ? path_of(scene(), m_marks.crossing->second.number) : nullptr;
    if (dot != nullptr && path != nullptr) {
        const auto at = std::ranges::find(dots, dot) - dots.begin() + along;
        dot = dots[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, std::ssize(dots) - 1))];
        const auto way = path - scene().paths.data() + up;
        path = &scene().paths[static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(way, 0, std::ssize(scene().paths) - 1))];
    } else {
        dot = *std::ranges::find_if(dots,
                                    [&](const SceneDot* one) { return one->yarn.position >= seen().first; });
        path = &scene().paths.front();
    }
    const SliceYarnId dot_yarn = dot->yarn, path_yarn = path->yarn;
    reveal(dot_yarn);  // may lay out anew
    m_marks.crossing = {dot_yarn, path_yarn};
    const SceneDot* new_dot = dot_of(scene(), dot_yarn);
    const ScenePath* new_path = path_of(scene(), path_yarn.number);
    if (new_dot == nullptr || new_path == nullptr) return;
    if (const auto crossing = crossing_of(*new_dot, *new_path)) Q_EMIT status(words_of(*crossing));
    update();
}

bool SliceReadCanvas::event(QEvent* event) {
    return claims_key(*event, {Qt::Key_F, Qt::Key_Plus, Qt::Key_Minus, Qt::Key_Space}) || SliceCanvas::event(event);
}

void SliceReadCanvas::keyPressEvent(QKeyEvent* event) {
    switch (event->key()) {
        case Qt::Key_Left:
            return step(-1, 0);
        case Qt::Key_Right:
            return step(1, 0);
        case Qt::Key_Up:
            return step(0, 1);
        case Qt::Key_Down:
            return step(0, -1);
        case Qt::Key_F:
            return fit();
        case Qt::Key_Plus:
            return zoom_in();
        case Qt::Key_Minus:
            return zoom_out();
        case Qt::Key_Home:
            return go_to(0);
        case Qt::Key_Return:
        case Qt::Key_Enter:
        case Qt::Key_Space: {
            if (!m_marks.crossing) return;
            const SceneDot* dot = dot_of(scene(), m_marks.crossing->first);
            const ScenePath* path = path_of(scene(), m_marks.crossing->second.number);
            const auto crossing = dot != nullptr && path != nullptr ? crossing_of(*dot, *path) : std::nullopt;
            if (crossing) ask_flip(*crossing, place_of(dot->yarn.position, static_cast<double>(dot->level)));
            return;
        }
        default:
            SliceCanvas::keyPressEvent(event);
    }
}

}  // namespace weave::studio
