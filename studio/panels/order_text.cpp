#include <studio/panels/order_text.hpp>

#include <QStringList>

namespace weave::studio {

QString with_numbers_moved(const QString& order, int by) {
    QStringList words;
    for (const QString& word : order.split(' ', Qt::SkipEmptyParts)) {
        const QString yarns = word.section('*', 0, 0), times = word.contains('*') ? "*" + word.section('*', 1) : QString();
        QStringList numbers;
        for (const QString& each : yarns.split('+')) {
            bool is_number = false;
            const int number = each.toInt(&is_number);
            numbers.push_back(is_number ? QString::number(number + by) : each);
        }
        words.push_back(numbers.join('+') + times);
    }
    return words.join(' ');
}

}  // namespace weave::studio
