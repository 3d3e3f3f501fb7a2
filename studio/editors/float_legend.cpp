#include <studio/editors/float_legend.hpp>

#include <weave/picture/canvas.hpp>
#include <weave/picture/float_map.hpp>
#include <studio/editors/slice_scene.hpp>

#include <QPainter>

#include <algorithm>

namespace weave::studio {

namespace {

/// Far beyond the length from which all floats have one colour.
constexpr std::int32_t long_float = 1000;

QColor ink(const QColor& ground) {
    const Colour colour{static_cast<std::uint8_t>(ground.red()), static_cast<std::uint8_t>(ground.green()), static_cast<std::uint8_t>(ground.blue())};
    return to_qt(ink_on(colour));
}

}  // namespace

FloatLegend::FloatLegend(QWidget* parent) : QWidget(parent) {
    setObjectName("float-legend");
    QStringList said;
    for (std::int32_t first = 1; first < long_float;) {
        std::int32_t last = first;
        while (last < long_float && float_colour(last + 1) == float_colour(first)) ++last;
        const QString words = last >= long_float ? tr("≥ %1").arg(first) : first == last ? QString::number(first) : tr("%1–%2").arg(first).arg(last);
        m_steps.push_back({words, to_qt(float_colour(first)), to_qt(float_colour(-first))});
        said.push_back(words);
        first = last + 1;
    }
    setAccessibleName(tr("Colours of floats, from light to dark: %1 stacks; blue for wefts, orange for warps").arg(said.join(", ")));
    setToolTip(tr("Over how many stacks in a row the same yarn stays on the surface"));
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
}

int FloatLegend::heading_width() const {
    return std::max(fontMetrics().horizontalAdvance(tr("Weft floats over")), fontMetrics().horizontalAdvance(tr("Warp floats over"))) + fontMetrics().averageCharWidth() * 2;
}

QSize FloatLegend::sizeHint() const {
    int widest = 0;
    for (const Step& step : m_steps) widest = std::max(widest, fontMetrics().horizontalAdvance(step.words));
    return {heading_width() + static_cast<int>(m_steps.size()) * (widest + fontMetrics().averageCharWidth() * 2), 2 * fontMetrics().height() + 12};
}

QSize FloatLegend::minimumSizeHint() const {
    return sizeHint();
}

void FloatLegend::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const int line = fontMetrics().height() + 2, left = fontMetrics().averageCharWidth(), begin = left + heading_width() - fontMetrics().averageCharWidth();
    const int wide = std::min((width() - begin - 4) / static_cast<int>(m_steps.size()), fontMetrics().averageCharWidth() * 8);
    for (const bool weft : {true, false}) {
        const int top = weft ? 2 : line + 6;
        painter.setPen(palette().color(QPalette::WindowText));
        painter.drawText(QRect(left, top, begin - left, line), Qt::AlignVCenter, weft ? tr("Weft floats over") : tr("Warp floats over"));
        for (std::size_t k = 0; k < m_steps.size(); ++k) {
            const QRect box(begin + static_cast<int>(k) * wide, top, wide - 2, line);
            const QColor& ground = weft ? m_steps[k].weft : m_steps[k].warp;
            painter.fillRect(box, ground);
            painter.setPen(ink(ground));
            painter.drawText(box, Qt::AlignCenter, m_steps[k].words);
        }
    }
}

}  // namespace weave::studio
