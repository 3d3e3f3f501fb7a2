#include <weave/picture/scale_marks.hpp>

#include <cmath>
#include <cstdio>

namespace weave {

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value == 0 ? 0.0 : value);
    return text;
}

double round_step(double most) {
    const double power = std::pow(10, std::floor(std::log10(most)));
    for (const double factor : {5.0, 2.0}) {
        if (factor * power <= most) return factor * power;
    }
    return power;
}

std::vector<double> scale_marks(double low, double high) {
    const double range = high - low, step = round_step(range / 4);
    std::vector<double> marks;
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * range; ++k)
        marks.push_back(k * step);
    return marks;
}

}  // namespace weave
