#include <studio/editors/slice_paint.hpp>

#include <weave/picture/canvas.hpp>

#include <QCoreApplication>
#include <QFontMetricsF>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

struct Words {
    Q_DECLARE_TR_FUNCTIONS(SlicePainter)
};

QColor mixed(const QColor& a, const QColor& b, double share) {
    const auto part = [&](int one, int other) {
        return static_cast<int>(std::lround(one + (other - one) * share));
    };
    return {part(a.red(), b.red()), part(a.green(), b.green()), part(a.blue(), b.blue())};
}
QColor see_through(QColor colour, int alpha) {
    colour.setAlpha(alpha);
    return colour;
}
Colour from_qt(const QColor& colour) {
    return {static_cast<std::uint8_t>(colour.red()), static_cast<std::uint8_t>(colour.green()),
            static_cast<std::uint8_t>(colour.blue())};
}

/// The drawer of one slice.
class SlicePainter {
  public:
    SlicePainter(QPainter& painter, const SliceView& view, const SliceScene& scene, const SliceMarks& marks,
                 const QRectF& space, const QPalette& palette)
        : m_painter(painter),
          m_view(view),
          m_scene(scene),
          m_marks(marks),
          m_space(space),
          m_paper(palette.color(QPalette::Base)),
          m_ink(palette.color(QPalette::Text)),
          m_is_dark(m_paper.lightness() < m_ink.lightness()) {
        m_first = std::max<double>(std::floor(view.position_at(space.left())) - 1,
                                   static_cast<double>(scene.begin));
        m_last = std::min<double>(std::ceil(view.position_at(space.right())) + 1,
                                  static_cast<double>(scene.begin + scene.positions) - 1);
    }

    void draw() {
        draw_rows();
        if (m_last < m_first) return;
        for (const ScenePath& path : m_scene.paths) draw_halo(path);
        for (const ScenePath& path : m_scene.paths) draw_path(path);
        draw_turns();
        for (const SceneDot& dot : m_scene.dot_list) draw_dot(dot);
        for (const ScenePath& path : m_scene.paths) draw_name(path);
        draw_wishes();
    }

  private:
    [[nodiscard]] bool is_fine() const { return m_view.radius() >= 4.5; }  ///< details can be told apart
    [[nodiscard]] bool marked(const SliceYarnId& yarn) const {
        return m_marks.selected.contains(yarn) || is_crossing(yarn);
    }
    [[nodiscard]] bool is_crossing(const SliceYarnId& yarn) const {
        return m_marks.crossing && (m_marks.crossing->first == yarn || m_marks.crossing->second == yarn);
    }
    [[nodiscard]] QColor halo_of(const SliceYarnId& yarn) const {
        if (marked(yarn)) return is_crossing(yarn) ? QColor(wished_ink) : QColor(chosen_ink);
        return mixed(QColor(chosen_ink), m_paper, 0.55);
    }

    /// A yarn's colour for letters on the paper.
    [[nodiscard]] QColor legible(const QColor& colour) const {
        return m_is_dark ? mixed(colour, Qt::white, 0.45) : to_qt(readable(from_qt(colour)));
    }

    void draw_rows() {
        const QColor faint = mixed(m_paper, m_ink, 0.12);
        m_painter.setPen(QPen(faint, 1));
        const double left = m_view.at(m_first - 0.45, 0).x(), right = m_view.at(m_last + 0.45, 0).x();
        for (std::size_t level = 0; level < m_scene.levels; ++level) {
            const double y = m_view.at(0, static_cast<double>(level)).y();
            if (y < m_space.top() || y > m_space.bottom()) continue;
            m_painter.drawLine(QPointF(left, y), QPointF(right, y));
        }
        if (!is_fine()) return;
        const double top = m_view.at(0, static_cast<double>(m_scene.levels) - 0.6).y(),
                     bottom = m_view.at(0, -0.4).y();
        for (double position = m_first; position <= m_last; ++position) {
            const double x = m_view.at(position, 0).x();
            m_painter.drawLine(QPointF(x, top), QPointF(x, bottom));
        }
    }

    /// The part of the path between these positions that can be seen; nothing where none can.
    [[nodiscard]] std::optional<QPainterPath> seen(const ScenePath& path, double from, double to) const {
        from = std::max({from, static_cast<double>(path.first), m_first});
        to = std::min({to, static_cast<double>(path.last()), m_last});
        if (from > to) return {};
        return curve_of(m_view, m_scene, path, static_cast<std::size_t>(from), static_cast<std::size_t>(to));
    }
    [[nodiscard]] std::optional<QPainterPath> seen(const ScenePath& path) const {
        return seen(path, 0, static_cast<double>(path.last()));
    }

    void stroke(const QPainterPath& curve, const QColor& colour, double width,
                Qt::PenStyle style = Qt::SolidLine) {
        QPen pen(colour, width, style, Qt::RoundCap, Qt::RoundJoin);
        if (style == Qt::CustomDashLine) pen.setDashPattern({0.1, 2.4});
        m_painter.setBrush(Qt::NoBrush);
        m_painter.strokePath(curve, pen);
    }

    void draw_halo(const ScenePath& path) {
        if (m_marks.preview || (!marked(path.yarn) && m_marks.hovered != path.yarn)) return;
        if (const auto curve = seen(path)) stroke(*curve, halo_of(path.yarn), m_view.path_width() + 9);
    }

    void draw_path(const ScenePath& path) {
        const double width = m_view.path_width();
        const auto woven_first = static_cast<double>(path.woven_first),
                   woven_last = static_cast<double>(path.woven_last);
        const bool whole = path.woven_first == path.first && path.woven_last == path.last();
        if (!whole) {  // what is drawn but not in the cloth
            if (const auto rest = seen(path))
                stroke(*rest, mixed(path.colour, m_paper, 0.35), width * 0.55, Qt::CustomDashLine);
        }
        if (path.woven_first > path.woven_last) return;
        double from = woven_first;
        while (from <= woven_last) {  // stretches that are loose on purpose, and those that are not
            const std::size_t begin = static_cast<std::size_t>(from) - path.first;
            std::size_t end = begin;
            while (end + 1 < path.levels.size() && path.loose[end + 1] == path.loose[begin]) ++end;
            const double to = std::min(static_cast<double>(path.first + end), woven_last);
            const auto curve = seen(path, from, std::min(to + 1, woven_last));
            if (curve && path.loose[begin]) stroke(*curve, path.colour, width * 0.6, Qt::CustomDashLine);
            if (curve && !path.loose[begin]) {
                stroke(*curve, mixed(path.colour, Qt::black, 0.45), width + std::max(1.2, width * 0.28));
                stroke(*curve, path.colour, width);
                if (is_fine()) stroke(*curve, mixed(path.colour, Qt::white, 0.28), width * 0.28);
            }
            from = to + 1;
        }
        if (is_fine()) draw_arrows(path);
    }

    void arrow(QPointF tip, QPointF ahead, double length, const QColor& colour) {
        const QPointF side(-ahead.y(), ahead.x());
        const QPointF back = tip - ahead * length;
        const QPolygonF head({tip, back + side * length * 0.48, back - side * length * 0.48});
        m_painter.setPen(QPen(m_paper, 1.5));
        m_painter.setBrush(colour);
        m_painter.drawPolygon(head);
    }

    void draw_arrows(const ScenePath& path) {
        for (const std::size_t place : path.arrows) {
            const auto here = static_cast<double>(place);
            if (here < m_first || here + 1 > m_last || place >= path.last()) continue;
            const QPainterPath step = curve_of(m_view, m_scene, path, place, place + 1);
            const double middle = step.percentAtLength(step.length() * 0.5);
            const double angle = step.angleAtPercent(middle) / 180 * std::acos(-1.0);
            const QPointF ahead = QPointF(std::cos(angle), -std::sin(angle)) * (path.leftwards ? -1 : 1);
            const double length = m_view.radius() * 1.3;
            arrow(step.pointAtPercent(middle) + ahead * length / 2, ahead, length,
                  mixed(path.colour, Qt::black, 0.62));
        }
    }

    [[nodiscard]] QPointF end_of(const ScenePath& path, bool right) const {
        const std::size_t place = right ? path.woven_last : path.woven_first;
        return m_view.at(static_cast<double>(place), static_cast<double>(path.levels[place - path.first]));
    }

    void draw_turns() {
        std::vector<std::pair<double, double>> left, right;  // what the arcs so far span
        std::vector<const SceneTurn*> turns;
        const auto height = [&](const SceneTurn* turn) {
            if (!turn->from || !turn->to) return 0.0;
            return std::abs(end_of(m_scene.paths[*turn->from], turn->right).y() -
                            end_of(m_scene.paths[*turn->to], turn->right).y());
        };
        for (const SceneTurn& turn : m_scene.turns) turns.push_back(&turn);
        std::ranges::stable_sort(turns, {}, height);
        for (const SceneTurn* turn : turns) {
            if (!turn->from || !turn->to) {
                draw_way_out(*turn);
                continue;
            }
            draw_turn(*turn, turn->right ? right : left);
        }
    }

    /// An arc round the side; wide ones go round narrow ones.
    void draw_turn(const SceneTurn& turn, std::vector<std::pair<double, double>>& arcs) {
        const ScenePath &from = m_scene.paths[*turn.from], &to = m_scene.paths[*turn.to];
        const QPointF a = end_of(from, turn.right), b = end_of(to, turn.right);
        const double low = std::min(a.y(), b.y()), high = std::max(a.y(), b.y());
        const auto inside = std::ranges::count_if(
            arcs, [&](const auto& arc) { return arc.first < high && low < arc.second; });
        arcs.emplace_back(low, high);
        const double out = turn.right ? 1 : -1,
                     outermost = turn.right ? std::max(a.x(), b.x()) : std::min(a.x(), b.x());
        const double reach =
            outermost + out * m_view.across() * std::min(0.75 + 0.38 * static_cast<double>(inside), 1.9);
        QPainterPath arc(a);
        arc.cubicTo({reach, a.y()}, {reach, b.y()}, b);
        const QColor colour = turn.caught ? from.colour : m_ink;
        const double width = m_view.path_width();
        if (turn.caught) {
            stroke(arc, mixed(colour, Qt::black, 0.45), width + std::max(1.2, width * 0.28));
            stroke(arc, colour, width);
        } else {
            stroke(arc, colour, width * 0.6, Qt::CustomDashLine);
        }
        if (!is_fine()) return;
        const QPointF middle = arc.pointAtPercent(0.5), ahead(0, b.y() > a.y() ? 1 : -1);
        const double length = m_view.radius() * 1.1;
        arrow(middle + ahead * length / 2, ahead, length, mixed(colour, Qt::black, 0.5));
    }

    /// A yarn that goes to, or comes from, a pick that this slice does not show.
    void draw_way_out(const SceneTurn& turn) {
        const ScenePath& path = m_scene.paths[turn.from ? *turn.from : *turn.to];
        if (path.woven_first > path.woven_last) return;
        const double out = turn.right ? 1 : -1;
        const QPointF end = end_of(path, turn.right), tip = end + QPointF(out * m_view.across() * 0.62, 0);
        const QColor colour = turn.caught ? legible(path.colour) : m_ink;
        m_painter.setPen(QPen(colour, 2, Qt::DotLine));
        m_painter.drawLine(end, tip);
        if (!is_fine()) return;
        const double length = m_view.radius();
        if (turn.from) arrow(tip + QPointF(out * 2, 0), {out, 0}, length, colour);
        QString words = (turn.from ? Words::tr("to %1") : Words::tr("from %1")).arg(turn.other_pick + 1);
        if (!turn.caught) words += " " + Words::tr("(not caught)");
        write(words, tip + QPointF(out * 6, turn.from ? -m_view.radius() : m_view.radius()),
              turn.right ? Qt::AlignLeft : Qt::AlignRight, mixed(m_ink, m_paper, 0.3), 0.72, false);
    }

    void draw_dot(const SceneDot& dot) {
        const auto position = static_cast<double>(dot.yarn.position);
        if (position < m_first || position > m_last) return;
        const QPointF centre = m_view.at(position, static_cast<double>(dot.level));
        const double radius = m_view.radius();
        if (marked(dot.yarn) || m_marks.hovered == dot.yarn) {
            m_painter.setPen(Qt::NoPen);
            m_painter.setBrush(halo_of(dot.yarn));
            m_painter.drawEllipse(centre, radius + 4.5, radius + 4.5);
        }
        const bool off = !dot.number;
        const QColor fill = off         ? m_paper
                            : dot.loose ? mixed(dot.colour, m_paper, 0.7)
                                        : dot.colour;
        QPen rim(off ? mixed(dot.colour, m_ink, 0.3) : mixed(dot.colour, m_is_dark ? Qt::white : Qt::black, 0.45),
                 is_fine() ? 1.4 : 0.7);
        if (off || dot.loose) rim.setDashPattern({2.5, 2});
        m_painter.setPen(rim);
        m_painter.setBrush(fill);
        m_painter.drawEllipse(centre, radius, radius);
        if (!is_fine()) return;
        if (off) {  // crossed out, as a yarn that is not woven
            const double reach = radius * 0.45;
            m_painter.drawLine(centre + QPointF(-reach, -reach), centre + QPointF(reach, reach));
            m_painter.drawLine(centre + QPointF(-reach, reach), centre + QPointF(reach, -reach));
            return;
        }
        const QString number = QString::number(*dot.number + 1);
        const double size = number.size() <= 2 ? 0.76 : number.size() == 3 ? 0.6 : 0.48;
        write(number, centre, Qt::AlignHCenter, to_qt(ink_on(from_qt(fill))), size, true);
    }

    /// Words whose letters are `size` of a line high at zoom 1; `place` is the middle of their height.
    void write(const QString& words, QPointF place, Qt::Alignment side, const QColor& colour, double size,
               bool bold, bool ground = false) {
        QFont font = m_painter.font();
        font.setPixelSize(std::max(4, static_cast<int>(std::lround(m_view.radius() / 0.7 * size))));
        font.setBold(bold);
        const QFontMetricsF metrics(font);
        const double width = metrics.horizontalAdvance(words);
        double left = place.x();
        if (side == Qt::AlignHCenter) left -= width / 2;
        if (side == Qt::AlignRight) left -= width;
        if (ground) {
            m_painter.setPen(Qt::NoPen);
            m_painter.setBrush(see_through(m_paper, 225));
            m_painter.drawRoundedRect(
                QRectF(left - 3, place.y() - metrics.height() / 2, width + 6, metrics.height()), 3, 3);
        }
        m_painter.save();
        m_painter.setFont(font);
        m_painter.setPen(colour);
        m_painter.drawText(QPointF(left, place.y() + metrics.capHeight() / 2), words);
        m_painter.restore();
    }

    [[nodiscard]] QString name_of(const ScenePath& path) const {
        return path.number ? QString::number(*path.number + 1) : Words::tr("off");
    }

    /// The path's number at the edges it runs to, on the yarn where it turns, and now and then along a long
    /// way.
    void draw_name(const ScenePath& path) {
        if (!is_fine()) return;
        const QColor colour = legible(path.colour);
        const auto level = [&](std::size_t position) {
            return static_cast<double>(path.levels[position - path.first]);
        };
        const auto tag = [&](std::size_t position) {
            write(name_of(path), m_view.at(static_cast<double>(position), level(position)), Qt::AlignHCenter,
                  colour, 0.72, true, true);
        };
        const bool woven = path.number && path.woven_first <= path.woven_last;
        if (path.first == 0 && path.reaches_left) {
            write(name_of(path), m_view.at(-path_overhang - 0.12, level(0)), Qt::AlignRight, colour, 0.8,
                  true);
        } else if (woven && !path.reaches_left) {
            tag(path.woven_first);
        }
        if (path.last() + 1 == m_scene.all_positions && path.reaches_right) {
            write(name_of(path),
                  m_view.at(static_cast<double>(path.last()) + path_overhang + 0.12, level(path.last())),
                  Qt::AlignLeft, colour, 0.8, true);
        } else if (woven && !path.reaches_right && path.woven_last > path.woven_first + 1) {
            tag(path.woven_last);
        }
        const std::size_t from = static_cast<std::size_t>(m_first);
        for (std::size_t position = from - from % 10 + 4 + 3 * (path.yarn.number % 3);
             static_cast<double>(position) <= m_last; position += 10) {
            if (position > path.first && position + 6 < m_scene.all_positions && position < path.last())
                tag(position);
        }
    }

    /// What a gesture or a key would do.
    void draw_wishes() {
        if (m_marks.preview && !m_marks.preview->levels.empty()) {
            const PathPreview& preview = *m_marks.preview;
            const bool left = preview.first == 0,
                       right = preview.first + preview.levels.size() == m_scene.all_positions;
            const QPainterPath curve = curve_of(m_view, preview.first, preview.levels, {}, left, right);
            stroke(curve, see_through(m_paper, 220), m_view.path_width() + 6);
            stroke(curve, QColor(wished_ink), m_view.path_width() + 1);
        }
        if (m_marks.dot_preview) {
            m_painter.setPen(QPen(QColor(wished_ink), 2, Qt::DashLine));
            m_painter.setBrush(QColor(213, 94, 0, 40));
            m_painter.drawEllipse(m_view.at(m_marks.dot_preview->x(), m_marks.dot_preview->y()),
                                  m_view.radius(), m_view.radius());
        }
        if (!m_marks.path_place || m_marks.preview) return;
        for (const SliceYarnId& yarn : m_marks.selected) {
            const ScenePath* path = yarn.path ? path_of(m_scene, yarn.number) : nullptr;
            const auto level = path != nullptr ? path->level_at(*m_marks.path_place) : std::nullopt;
            if (!level) continue;
            const QPointF place =
                m_view.at(static_cast<double>(*m_marks.path_place), static_cast<double>(*level));
            m_painter.setPen(QPen(QColor(chosen_ink), 2));
            m_painter.setBrush(m_paper);
            m_painter.drawEllipse(place, m_view.radius() * 0.6, m_view.radius() * 0.6);
        }
    }

    QPainter& m_painter;
    const SliceView& m_view;
    const SliceScene& m_scene;
    const SliceMarks& m_marks;
    QRectF m_space;
    QColor m_paper, m_ink;
    bool m_is_dark;
    double m_first = 0, m_last = 0;
};

}  // namespace

void paint_slice(QPainter& painter, const SliceView& view, const SliceScene& scene, const SliceMarks& marks,
                 const QRectF& space, const QPalette& palette) {
    painter.save();
    painter.setClipRect(space);
    painter.setRenderHint(QPainter::Antialiasing);
    SlicePainter(painter, view, scene, marks, space, palette).draw();
    painter.restore();
}

void paint_ruler(QPainter& painter, const SliceView& view, const SliceScene& scene, const SliceMarks& marks,
                 const QRectF& ruler, const QPalette& palette) {
    painter.save();
    painter.setClipRect(ruler);
    painter.fillRect(ruler, palette.color(QPalette::Window));
    painter.setPen(palette.color(QPalette::Mid));
    painter.drawLine(ruler.topLeft(), ruler.topRight());
    const QFontMetricsF metrics(painter.font());
    const double widest =
        metrics.horizontalAdvance(QString::number(scene.all_positions)) + metrics.averageCharWidth() * 2;
    std::size_t step = 1;
    for (const std::size_t wish : {1U, 2U, 5U, 10U, 20U, 50U, 100U, 200U, 500U}) {
        step = wish;
        if (static_cast<double>(wish) * view.across() >= widest) break;
    }
    std::set<std::size_t> chosen;
    for (const SliceYarnId& yarn : marks.selected) {
        if (!yarn.path) chosen.insert(yarn.position);
    }
    if (marks.path_place) chosen.insert(*marks.path_place);
    const QColor ink = palette.color(QPalette::WindowText);
    const double baseline = ruler.top() + metrics.height() * 1.05;
    for (std::size_t position = scene.begin; position < scene.begin + scene.positions; ++position) {
        const double x = view.at(static_cast<double>(position), 0).x();
        if (x < ruler.left() - view.across() || x > ruler.right() + view.across()) continue;
        const bool is_chosen = chosen.contains(position);
        if (!is_chosen && (position + 1) % step != 0 && position != 0) continue;
        const QString number = QString::number(position + 1);
        painter.setPen(is_chosen ? mixed(QColor(chosen_ink), ink, 0.35) : ink);
        painter.drawLine(QPointF(x, ruler.top()), QPointF(x, ruler.top() + 3));
        painter.drawText(QPointF(x - metrics.horizontalAdvance(number) / 2, baseline), number);
    }
    const bool rows = scene.dots == System::weft;
    painter.setPen(palette.color(QPalette::WindowText));
    const double margin = metrics.averageCharWidth();
    const QString words[] = {rows ? Words::tr("Along the warp → position = row of wefts (picks one above the other)")
                                  : Words::tr("Along the weft → position = column of warps (ends one above the other)"),
                             rows ? Words::tr("Along the warp → rows") : Words::tr("Along the weft → columns")};
    const bool fits = metrics.horizontalAdvance(words[0]) + 2 * margin <= ruler.width();
    painter.drawText(QPointF(ruler.left() + margin, ruler.bottom() - metrics.descent() - 2), words[fits ? 0 : 1]);
    painter.restore();
}

}  // namespace weave::studio
