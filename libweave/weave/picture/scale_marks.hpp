#pragma once

#include <string>
#include <vector>

namespace weave {

/// Four digits, as marks and sizes are written.
std::string short_number(double value);
/// The largest of 1, 2 and 5 times a power of ten that is not above `most`, which is above 0.
double round_step(double most);
/// Round numbers from `low` to `high`, four to ten of them, for the marks of a scale.
std::vector<double> scale_marks(double low, double high);

}  // namespace weave
