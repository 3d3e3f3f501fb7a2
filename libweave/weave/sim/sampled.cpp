#include <weave/sim/sampled.hpp>

#include <algorithm>
#include <cmath>

namespace weave {

namespace {

/// The second derivative at the joint before segment `index`.
double bend_at(const Spline& spline, std::size_t index) {
    const auto at = static_cast<std::ptrdiff_t>(index);
    return (spline.at(at - 1) - 2 * spline.at(at) + spline.at(at + 1)).norm();
}

}  // namespace

std::vector<double> sample_parameters(const Spline& spline, double error_mm, std::size_t least) {
    std::vector<double> parameters;
    const std::size_t segments = spline.segments();
    if (segments == 0) return parameters;
    double before = bend_at(spline, 0);
    for (std::size_t segment = 0; segment < segments; ++segment) {
        const double after = bend_at(spline, segment + 1);
        const double wanted = std::ceil(std::sqrt(std::max(before, after) / (8 * error_mm)));
        const auto pieces = static_cast<std::size_t>(
            std::clamp(wanted, static_cast<double>(least), static_cast<double>(most_pieces)));
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            parameters.push_back(static_cast<double>(segment) +
                                 static_cast<double>(piece) / static_cast<double>(pieces));
        }
        before = after;
    }
    parameters.push_back(static_cast<double>(segments));
    return parameters;
}

double value_at(const Spline& spline, const std::vector<double>& values, double t) {
    const double floor = std::clamp(std::floor(t), 0.0, static_cast<double>(spline.segments()) - 1);
    const auto index = static_cast<std::size_t>(floor);
    const std::size_t next = (index + 1) % values.size();
    return values[index] + (values[next] - values[index]) * (t - floor);
}

}  // namespace weave
