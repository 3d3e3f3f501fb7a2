#include <weave/net/metrics.hpp>

#include <weave/core/json.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace weave::net {

namespace {

constexpr std::size_t most_series = 1000;

void add_to(std::atomic<double>& sum, double amount) {
    double old = sum.load();
    while (!sum.compare_exchange_weak(old, old + amount)) continue;
}

std::string number(double value) {
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
    return ecmascript_number(value);
}

std::string escaped(const std::string& text, bool quotes) {
    std::string result;
    for (const char c : text) {
        if (c == '\\')
            result += "\\\\";
        else if (c == '\n')
            result += "\\n";
        else if (c == '"' && quotes)
            result += "\\\"";
        else
            result += c;
    }
    return result;
}

std::string written(Labels labels) {
    std::sort(labels.begin(), labels.end());
    std::string text;
    for (const auto& [name, value] : labels)
        text += (text.empty() ? "" : ",") + name + "=\"" + escaped(value, true) + '"';
    return text;
}

std::string line(const std::string& name, const std::string& labels, double value) {
    return name + (labels.empty() ? "" : "{" + labels + "}") + " " + number(value) + "\n";
}

constexpr const char* kinds[] = {"counter", "gauge", "histogram"};  // in the order of Series

}  // namespace

void Counter::add(double amount) {
    assert(amount >= 0);
    add_to(m_value, amount);
}

void Gauge::add(double amount) {
    add_to(m_value, amount);
}

Histogram::Histogram(std::vector<double> bounds)
    : m_bounds(std::move(bounds)), m_counts(m_bounds.size() + 1) {
    assert(std::is_sorted(m_bounds.begin(), m_bounds.end()));
}

void Histogram::observe(double value) {
    const auto place = std::lower_bound(m_bounds.begin(), m_bounds.end(), value) - m_bounds.begin();
    const std::lock_guard lock(m_mutex);
    ++m_counts[static_cast<std::size_t>(place)];
    m_sum += value;
}

std::string Histogram::lines(const std::string& name, const std::string& labels) const {
    const std::lock_guard lock(m_mutex);
    std::string text;
    std::uint64_t total = 0;
    for (std::size_t k = 0; k < m_counts.size(); ++k) {
        total += m_counts[k];
        const std::string bound = k < m_bounds.size() ? number(m_bounds[k]) : "+Inf";
        text += line(name + "_bucket", labels + (labels.empty() ? "" : ",") + "le=\"" + bound + '"',
                     static_cast<double>(total));
    }
    return text + line(name + "_sum", labels, m_sum) +
           line(name + "_count", labels, static_cast<double>(total));
}

std::vector<double> duration_bounds() {
    return {0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10};
}

template <class Kind, class Make>
Kind& Metrics::find_or_make(const std::string& name, const std::string& help, const Labels& labels,
                            Make make) {
    const std::string key = written(labels);
    const std::lock_guard lock(m_mutex);
    Family& family = m_families[name];
    if (family.help.empty()) family.help = help;
    assert(family.help == help);
    auto found = family.series.find(key);
    if (found == family.series.end()) {
        const bool full = family.series.size() >= most_series;
        found = family.series.try_emplace(full ? "other=\"true\"" : key, make()).first;
    }
    const auto* const series = std::get_if<std::unique_ptr<Kind>>(&found->second);
    assert(series != nullptr);
    return **series;
}

Counter& Metrics::counter(const std::string& name, const std::string& help, const Labels& labels) {
    return find_or_make<Counter>(name, help, labels, [] { return std::make_unique<Counter>(); });
}

Gauge& Metrics::gauge(const std::string& name, const std::string& help, const Labels& labels) {
    return find_or_make<Gauge>(name, help, labels, [] { return std::make_unique<Gauge>(); });
}

Histogram& Metrics::histogram(const std::string& name, const std::string& help, const Labels& labels,
                              const std::vector<double>& bounds) {
    return find_or_make<Histogram>(name, help, labels, [&] { return std::make_unique<Histogram>(bounds); });
}

std::string Metrics::text() const {
    const std::lock_guard lock(m_mutex);
    std::string text;
    for (const auto& [name, family] : m_families) {
        text += "# HELP " + name + " " + escaped(family.help, false) + "\n";
        text += "# TYPE " + name + " " + kinds[family.series.begin()->second.index()] + "\n";
        for (const auto& [labels, series] : family.series) {
            if (const auto* const counter = std::get_if<std::unique_ptr<Counter>>(&series))
                text += line(name, labels, (*counter)->value());
            else if (const auto* const gauge = std::get_if<std::unique_ptr<Gauge>>(&series))
                text += line(name, labels, (*gauge)->value());
            else
                text += std::get<std::unique_ptr<Histogram>>(series)->lines(name, labels);
        }
    }
    return text;
}

}  // namespace weave::net
