#include <studio/panels/order_text.hpp>

#include <QCoreApplication>
#include <QRegularExpression>
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

QString wrong_in_order(const QString& order, int count, bool is_of_feeders) {
    static const QRegularExpression run(R"(^[0-9]+(\*0*[1-9][0-9]*)?$)"), feeders(R"(^(-|[0-9]+(\+[0-9]+)*)(\*0*[1-9][0-9]*)?$)");
    for (const QString& word : order.split(' ', Qt::SkipEmptyParts)) {
        if (!(is_of_feeders ? feeders : run).match(word).hasMatch())
            return QCoreApplication::translate("YarnsPanel", "'%1' is neither a number nor a run such as 1*12").arg(word.left(40));
        const QString numbers = word.section('*', 0, 0);
        if (numbers == "-") continue;
        for (const QString& number : numbers.split('+')) {
            bool is_small = false;
            const int at = number.toInt(&is_small);
            if (!is_small || at < 1 || at > count)
                return QCoreApplication::translate("YarnsPanel", "there is no number %1: they go from 1 to %2").arg(number.left(20)).arg(count);
        }
    }
    return {};
}

}  // namespace weave::studio
