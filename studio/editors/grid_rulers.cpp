#include <studio/editors/grid_rulers.hpp>

#include <QPainter>
#include <QWidget>

#include <algorithm>

namespace weave::studio {

namespace {

const QColor origin_colour(0xd5, 0x5e, 0x00);

double triangle(const QWidget& widget) {
    return widget.fontMetrics().height() * 0.55;
}

}  // namespace

GridLabels plain_labels(const QString& row_word, const QString& column_word) {
    const auto same = [](std::size_t number) { return number; };
    const auto never = [](std::size_t) { return false; };
    return {row_word, column_word, same, same, never, never};
}

PrintedNumbers::PrintedNumbers(double cell, double room, std::size_t repeat, std::size_t lines, std::size_t most_in_line)
    : m_cell(cell), m_room(room), m_repeat(std::max<std::size_t>(repeat, 1)), m_lines(lines) {
    if (cell >= room) return;
    // Between two numbers that are so far apart there are at least as many lines.
    const auto fits = [&](std::size_t step) { return static_cast<double>(step / most_in_line) * cell >= room; };
    for (std::size_t ten = 1; !fits(m_step); ten *= 10) {  // the smallest of 1, 2, 5, 10 … that leaves room
        for (const std::size_t times : {1, 2, 5}) {
            m_step = ten * times;
            if (fits(m_step)) break;
        }
    }
}

std::optional<std::size_t> PrintedNumbers::beside(std::size_t line, std::size_t first, std::size_t next) const {
    const std::size_t place = line % m_repeat, left = m_repeat - place;
    const auto fits = [&](std::size_t lines) { return static_cast<double>(lines) * m_cell >= m_room; };
    if (place == 0) return line == 0 || fits(m_repeat) ? std::optional(first) : std::nullopt;
    const std::size_t number = (first + m_step - 1) / m_step * m_step;
    const bool is_last_repeat = line + left >= m_lines;
    if (number >= next || !fits(place) || (!is_last_repeat && !fits(left))) return std::nullopt;
    return number;
}

void GridRulers::set(GridLabels labels, std::size_t rows, std::size_t columns) {
    m_labels = std::move(labels);
    m_rows = rows;
    m_columns = columns;
    const auto most = [](const auto& number_of, std::size_t lines) {
        std::size_t found = 1;
        for (std::size_t line = 0; line < lines; ++line) found = std::max(found, number_of(line + 1) - number_of(line));
        return found;
    };
    m_most_in_row = most(m_labels.number_of_row, rows);
    m_most_in_column = most(m_labels.number_of_column, columns);
}

double GridRulers::number_width(const QWidget& widget) const {
    const std::size_t most = m_labels.number_of_row(m_rows);
    return widget.fontMetrics().horizontalAdvance(QString::number(std::max<std::size_t>(most, 100)));
}

double GridRulers::column_number_width(const QWidget& widget) const {
    const std::size_t most = m_labels.number_of_column(m_columns);
    return widget.fontMetrics().horizontalAdvance(QString::number(most));
}

QRectF GridRulers::room_in(const QWidget& widget, Corner corner) const {
    const double line = widget.fontMetrics().height(), arrow = triangle(widget);
    const bool goes_left = corner == Corner::bottom_right || corner == Corner::top_right;
    const double right = std::max(goes_left ? arrow + 6 : 4, column_number_width(widget) / 2);  // the last number is whole
    return QRectF(widget.rect()).adjusted(line * 1.3 + arrow + number_width(widget) + 12, 4, -right, -line * 2 - 6);
}

void GridRulers::paint(QPainter& painter, const QWidget& widget, const GridMapping& mapping) const {
    painter.setPen(widget.palette().color(QPalette::WindowText));
    paint_row_numbers(painter, widget, mapping);
    paint_column_numbers(painter, widget, mapping);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(origin_colour);
    painter.drawPolygon(origin(widget, mapping));
}

void GridRulers::paint_row_numbers(QPainter& painter, const QWidget& widget, const GridMapping& mapping) const {
    const GridSpan span = mapping.seen();
    const double high = widget.fontMetrics().height(), wide = number_width(widget);
    const PrintedNumbers printed(mapping.cell(), high * 1.3, m_rows, mapping.rows(), m_most_in_row);
    const double right = std::max(mapping.room().left(), mapping.frame().left()) - 6;
    for (std::size_t row = span.first_row; row < span.last_row; ++row) {
        const auto number = printed.beside(row, m_labels.number_of_row(row % m_rows) + 1, m_labels.number_of_row(row % m_rows + 1) + 1);
        const double middle = mapping.box({row, 0}).center().y();
        if (middle < high / 2 || !number) continue;
        painter.drawText(QRectF(right - wide, middle - high / 2, wide, high), Qt::AlignRight | Qt::AlignVCenter, QString::number(*number));
    }
    painter.save();
    painter.translate(high * 0.75, mapping.room().center().y());
    painter.rotate(-90);
    const QString word = mapping.rows_go_up() ? m_labels.row_word + " →" : "← " + m_labels.row_word;
    painter.drawText(QRectF(-200, -high / 2, 400, high), Qt::AlignCenter, word);
    painter.restore();
}

void GridRulers::paint_column_numbers(QPainter& painter, const QWidget& widget, const GridMapping& mapping) const {
    const GridSpan span = mapping.seen();
    const double high = widget.fontMetrics().height();
    const PrintedNumbers printed(mapping.cell(), column_number_width(widget) + 8, m_columns, mapping.columns(), m_most_in_column);
    const double top = std::min(mapping.room().bottom(), mapping.frame().bottom()) + 3;
    for (std::size_t column = span.first_column; column < span.last_column; ++column) {
        const auto number = printed.beside(column, m_labels.number_of_column(column % m_columns) + 1, m_labels.number_of_column(column % m_columns + 1) + 1);
        const double middle = mapping.box({0, column}).center().x();
        if (middle < mapping.room().left() || middle > mapping.room().right() || !number) continue;
        painter.drawText(QRectF(middle - 40, top, 80, high), Qt::AlignHCenter | Qt::AlignTop, QString::number(*number));
    }
    const QString word = mapping.columns_go_right() ? m_labels.column_word + " →" : "← " + m_labels.column_word;
    painter.drawText(QRectF(mapping.room().left(), widget.height() - high - 1, mapping.room().width(), high), Qt::AlignCenter, word);
}

QPolygonF GridRulers::origin(const QWidget& widget, const GridMapping& mapping) const {
    const QRectF& room = mapping.room();
    const double size = triangle(widget), half = size * 0.6, wish = mapping.box({0, 0}).center().y();
    const double y = std::clamp(wish, room.top() + half, std::max(room.top() + half, room.bottom() - half));
    const bool from_left = mapping.columns_go_right();
    const double inner = from_left ? std::max(room.left(), mapping.frame().left()) - 6 - number_width(widget) - 3 : std::min(room.right(), mapping.frame().right()) + 2;
    const double outer = from_left ? inner - size : inner + size, middle = (inner + outer) / 2;
    if (wish > room.bottom()) return {{{middle, y + half}, {inner, y - half}, {outer, y - half}}};
    if (wish < room.top()) return {{{middle, y - half}, {inner, y + half}, {outer, y + half}}};
    return {{{inner, y}, {outer, y - half}, {outer, y + half}}};
}

}  // namespace weave::studio
