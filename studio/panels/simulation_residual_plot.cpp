#include <studio/panels/simulation_residual_plot.hpp>

#include <QFontMetricsF>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

constexpr std::size_t most_points = 8192;

/// Okabe and Ito's colours, which all can tell apart, on light and on dark ground.
QColor curve_colour(bool dark) {
    return dark ? QColor(0x56, 0xb4, 0xe9) : QColor(0x00, 0x72, 0xb2);
}
QColor goal_colour(bool dark) {
    return dark ? QColor(0xe6, 0x9f, 0x00) : QColor(0xc0, 0x50, 0x00);
}

QString decade_label(int decade) {
    if (decade >= -3 && decade <= 3) return QString::number(std::pow(10, decade), 'g', 4);
    return QStringLiteral("1e%1").arg(decade);
}

}  // namespace

ResidualPlot::ResidualPlot(QWidget* parent) : QWidget(parent) {
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    setAccessibleName(tr("Residual by step"));
    setToolTip(
        tr("How much force is left, against the force that holds the cloth, after each step.\nThe dashed "
           "line is where it counts as at rest. Click for a value; the arrow keys go on from there."));
}

QSize ResidualPlot::sizeHint() const {
    const int line = fontMetrics().height();
    return {22 * line, 10 * line};
}

QSize ResidualPlot::minimumSizeHint() const {
    const int line = fontMetrics().height();
    return {12 * line, 7 * line};
}

void ResidualPlot::clear() {
    m_points.clear();
    m_marked.reset();
    update();
}

void ResidualPlot::add(const std::vector<ResidualPoint>& points) {
    for (const ResidualPoint& point : points) {
        if (!(point.residual > 0) || !std::isfinite(point.residual)) continue;
        if (!m_points.empty() &&
            point.step < m_points.back().step) {  // a server went on from an earlier step
            std::erase_if(m_points, [&](const ResidualPoint& old) { return old.step >= point.step; });
            m_marked.reset();
        }
        m_points.push_back(point);
    }
    thin_out();
    update();
}

/// Every second point goes where there are more than can be seen.
void ResidualPlot::thin_out() {
    while (m_points.size() > most_points) {
        const ResidualPoint last = m_points.back();
        for (std::size_t k = 0; 2 * k < m_points.size(); ++k) m_points[k] = m_points[2 * k];
        m_points.resize((m_points.size() + 1) / 2);
        if (m_points.back().step != last.step) m_points.push_back(last);
        if (m_marked) *m_marked /= 2;
    }
}

void ResidualPlot::set_goal(double goal) {
    if (m_goal == goal) return;
    m_goal = goal;
    update();
}

std::optional<ResidualPoint> ResidualPlot::marked() const {
    if (!m_marked || *m_marked >= m_points.size()) return {};
    return m_points[*m_marked];
}

ResidualScale ResidualPlot::scale() const {
    const QFontMetricsF font(this->font());
    const double line = font.height(), left = font.horizontalAdvance(QStringLiteral("0.0001")) + line / 2;
    const QRectF area(left, line / 2, std::max(1.0, width() - left - line),
                      std::max(1.0, height() - 2.75 * line));
    double least = m_goal > 0 ? m_goal : 1e-3, most = least;
    for (const ResidualPoint& point : m_points) {
        least = std::min(least, point.residual);
        most = std::max(most, point.residual);
    }
    return {area, m_points.empty() ? 100 : m_points.back().step, least, m_points.empty() ? 1 : most};
}

bool ResidualPlot::is_dark() const {
    return palette().color(QPalette::Base).lightness() < 128;
}

// ---- Drawing ----

void ResidualPlot::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.fillRect(rect(), palette().color(QPalette::Base));
    const ResidualScale scale = this->scale();
    draw_grid(painter, scale);
    draw_goal(painter, scale);
    draw_curve(painter, scale);
    draw_mark(painter, scale);
    if (!hasFocus()) return;
    painter.setPen(QPen(palette().color(QPalette::Highlight), 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

/// Below the numbers of the steps, where no curve comes: what axis and dashed line mean.
QRectF ResidualPlot::foot(const ResidualScale& scale) const {
    const double line = QFontMetricsF(font()).height(), left = line / 2, right = scale.area().right();
    return {left, scale.area().bottom() + 1.1 * line, right - left, 1.2 * line};
}

void ResidualPlot::draw_grid(QPainter& painter, const ResidualScale& scale) const {
    const QFontMetricsF font(this->font());
    const QRectF& area = scale.area();
    QColor text = palette().color(QPalette::Text), grid = text;
    grid.setAlphaF(0.15F);
    text.setAlphaF(0.75F);
    for (const int decade : scale.decades(static_cast<int>(area.height() / (1.6 * font.height())))) {
        const double y = scale.y_of(std::pow(10, decade));
        painter.setPen(QPen(grid, 1));
        painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
        painter.setPen(text);
        painter.drawText(QRectF(0, y - font.height(), area.left() - font.height() / 3, 2 * font.height()),
                         Qt::AlignRight | Qt::AlignVCenter, decade_label(decade));
    }
    for (const std::uint64_t step : scale.steps(static_cast<int>(area.width() / (4.5 * font.height())))) {
        const double x = scale.x_of(static_cast<double>(step));
        painter.setPen(QPen(grid, 1));
        painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
        painter.setPen(text);
        painter.drawText(QRectF(x - 60, area.bottom() + font.height() * 0.15, 120, font.height()),
                         Qt::AlignHCenter | Qt::AlignTop, QString::number(step));
    }
    painter.setPen(text);
    painter.drawText(foot(scale), Qt::AlignRight | Qt::AlignVCenter, tr("steps"));
}

void ResidualPlot::draw_goal(QPainter& painter, const ResidualScale& scale) const {
    if (!(m_goal > 0)) return;
    const QFontMetricsF font(this->font());
    const QRectF& area = scale.area();
    const double y = scale.y_of(m_goal);
    const QColor colour = goal_colour(is_dark());
    painter.setPen(QPen(colour, std::max(1.0, font.height() / 10), Qt::DashLine));
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
    const QRectF foot = this->foot(scale);
    const double sample = 1.5 * font.height();
    painter.drawLine(QPointF(foot.left(), foot.center().y()), QPointF(foot.left() + sample, foot.center().y()));
    painter.setPen(colour);
    painter.drawText(foot.adjusted(sample + font.height() / 3, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter,
                     tr("at rest below %1").arg(QString::number(m_goal, 'g', 2)));
}

void ResidualPlot::draw_curve(QPainter& painter, const ResidualScale& scale) const {
    const QFontMetricsF font(this->font());
    if (m_points.empty()) {
        QColor text = palette().color(QPalette::Text);
        text.setAlphaF(0.6F);
        painter.setPen(text);
        painter.drawText(scale.area(), Qt::AlignCenter | Qt::TextWordWrap,
                         tr("The residual shows here once yarns move"));
        return;
    }
    QPainterPath path;
    for (std::size_t k = 0; k < m_points.size(); ++k) {
        const QPointF at(scale.x_of(static_cast<double>(m_points[k].step)), scale.y_of(m_points[k].residual));
        k == 0 ? path.moveTo(at) : path.lineTo(at);
    }
    const double thick = std::max(1.0, font.height() / 9);
    painter.setPen(QPen(curve_colour(is_dark()), thick, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(path);
    painter.setPen(Qt::NoPen);
    painter.setBrush(curve_colour(is_dark()));
    painter.drawEllipse(path.currentPosition(), 1.8 * thick, 1.8 * thick);
}

void ResidualPlot::draw_mark(QPainter& painter, const ResidualScale& scale) const {
    const std::optional<ResidualPoint> point = marked();
    if (!point) return;
    const QFontMetricsF font(this->font());
    const QRectF& area = scale.area();
    const QPointF at(scale.x_of(static_cast<double>(point->step)), scale.y_of(point->residual));
    const QColor text = palette().color(QPalette::Text);
    painter.setPen(QPen(text, 1, Qt::DotLine));
    painter.drawLine(QPointF(at.x(), area.top()), QPointF(at.x(), area.bottom()));
    painter.setPen(QPen(text, std::max(1.0, font.height() / 12)));
    painter.setBrush(palette().color(QPalette::Base));
    painter.drawEllipse(at, font.height() / 4, font.height() / 4);
    const QString words = tr("step %1: %2").arg(point->step).arg(QString::number(point->residual, 'g', 3));
    const double width = font.horizontalAdvance(words) + font.height(),
                 left = std::clamp(at.x() + font.height() / 2, area.left(), area.right() - width);
    const QRectF box(left, area.top() + font.height() / 4, width, font.height() * 1.4);
    painter.setPen(QPen(palette().color(QPalette::Mid), 1));
    painter.setBrush(palette().color(QPalette::ToolTipBase));
    painter.drawRoundedRect(box, font.height() / 5, font.height() / 5);
    painter.setPen(palette().color(QPalette::ToolTipText));
    painter.drawText(box, Qt::AlignCenter, words);
}

// ---- Asking for a value ----

void ResidualPlot::mark(std::optional<std::size_t> point) {
    m_marked = point;
    if (const auto one = marked())
        setAccessibleDescription(
            tr("Residual %1 after step %2").arg(QString::number(one->residual, 'g', 3)).arg(one->step));
    update();
}

void ResidualPlot::mark_at(double x) {
    if (m_points.empty()) return;
    const double step = scale().step_at(x);
    const auto after = std::ranges::lower_bound(
        m_points, step, {}, [](const ResidualPoint& point) { return static_cast<double>(point.step); });
    auto nearest = after == m_points.end() ? after - 1 : after;
    if (nearest != m_points.begin() &&
        step - static_cast<double>((nearest - 1)->step) < static_cast<double>(nearest->step) - step)
        --nearest;
    mark(static_cast<std::size_t>(nearest - m_points.begin()));
}

void ResidualPlot::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) mark_at(event->position().x());
}

void ResidualPlot::mouseMoveEvent(QMouseEvent* event) {
    if (event->buttons().testFlag(Qt::LeftButton)) mark_at(event->position().x());
}

void ResidualPlot::keyPressEvent(QKeyEvent* event) {
    const bool back = event->key() == Qt::Key_Left, on = event->key() == Qt::Key_Right;
    if (event->key() == Qt::Key_Escape && m_marked) return mark({});
    if (m_points.empty() || (!back && !on)) return QWidget::keyPressEvent(event);
    if (!m_marked) return mark(back ? m_points.size() - 1 : 0);
    if (back && *m_marked > 0) mark(*m_marked - 1);
    if (on && *m_marked + 1 < m_points.size()) mark(*m_marked + 1);
}

}  // namespace weave::studio
