#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace weave::net {

/// A number that only grows.
class Counter {
  public:
    void add(double amount = 1);
    [[nodiscard]] double value() const { return m_value.load(); }

  private:
    std::atomic<double> m_value{0};
};

/// A number that goes up and down.
class Gauge {
  public:
    void set(double value) { m_value = value; }
    void add(double amount);
    [[nodiscard]] double value() const { return m_value.load(); }

  private:
    std::atomic<double> m_value{0};
};

/// How many observations lay at or below each of some bounds.
class Histogram {
  public:
    /// `bounds` ascending.
    explicit Histogram(std::vector<double> bounds);
    void observe(double value);
    /// The lines of this series, `labels` as `a="b",c="d"` or empty.
    [[nodiscard]] std::string lines(const std::string& name, const std::string& labels) const;

  private:
    std::vector<double> m_bounds;
    mutable std::mutex m_mutex;
    std::vector<std::uint64_t> m_counts;  ///< one more than bounds
    double m_sum = 0;
};

/// Bounds for durations in seconds, from 1 ms to 10 s.
std::vector<double> duration_bounds();

using Labels = std::vector<std::pair<std::string, std::string>>;

/// The numbers a service tells about itself, as Prometheus text (format 0.0.4). All is safe to use from any
/// thread. A series is made when it is first asked for and stays at its address. Names are the programmer's,
/// and a name has one kind and one help text (asserted); label values may be anything. A name keeps at most
/// 1,000 series; from then on new labels share one series, labelled `other="true"`, so that no client can
/// fill the memory.
class Metrics {
  public:
    Counter& counter(const std::string& name, const std::string& help, const Labels& labels = {});
    Gauge& gauge(const std::string& name, const std::string& help, const Labels& labels = {});
    Histogram& histogram(const std::string& name, const std::string& help, const Labels& labels = {},
                         const std::vector<double>& bounds = duration_bounds());

    /// The text of all series, sorted by name and labels.
    [[nodiscard]] std::string text() const;

  private:
    using Series = std::variant<std::unique_ptr<Counter>, std::unique_ptr<Gauge>, std::unique_ptr<Histogram>>;
    struct Family {
        std::string help;
        std::map<std::string, Series> series;
    };

    template <class Kind, class Make>
    Kind& find_or_make(const std::string& name, const std::string& help, const Labels& labels, Make make);

    mutable std::mutex m_mutex;
    std::map<std::string, Family> m_families;
};

}  // namespace weave::net
