#pragma once

#include <QString>

namespace weave::studio {

/// An order of yarns or feeders as documents write it, counted from 0 (`0*12 1 0+1`), with every number moved: by 1 as people
/// read it, by -1 back. What is no number stays, and with it whatever is wrong.
QString with_numbers_moved(const QString& order, int by);

/// What is wrong with an order as people write it, counted from 1 (`1*12 2`; of feeders also `-` and `1+2`), where there are `count`
/// yarns or feeders; empty: nothing.
QString wrong_in_order(const QString& order, int count, bool is_of_feeders);

}  // namespace weave::studio
