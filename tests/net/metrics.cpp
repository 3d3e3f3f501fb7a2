#include <weave/net/metrics.hpp>

#include <catch2/catch.hpp>

#include <thread>

using namespace weave::net;

TEST_CASE("metrics are written as Prometheus reads them") {
    Metrics metrics;
    metrics.counter("b_total", "Things", {{"route", "a\"\\\nb"}, {"kind", "x"}}).add(2);
    metrics.counter("b_total", "Things", {{"kind", "x"}, {"route", "a\"\\\nb"}}).add();
    metrics.gauge("a", "Depth\nof it").set(-1.5);
    Histogram& histogram = metrics.histogram("c_seconds", "Time", {{"r", "q"}}, {0.5, 1});
    for (const double value : {0.25, 0.5, 0.75, 7.0}) histogram.observe(value);
    metrics.histogram("d", "Bare", {}, {1}).observe(2);
    REQUIRE(
        metrics.text() ==
        "# HELP a Depth\\nof it\n# TYPE a gauge\na -1.5\n"
        "# HELP b_total Things\n# TYPE b_total counter\nb_total{kind=\"x\",route=\"a\\\"\\\\\\nb\"} 3\n"
        "# HELP c_seconds Time\n# TYPE c_seconds histogram\n"
        "c_seconds_bucket{r=\"q\",le=\"0.5\"} 2\nc_seconds_bucket{r=\"q\",le=\"1\"} 3\n"
        "c_seconds_bucket{r=\"q\",le=\"+Inf\"} 4\nc_seconds_sum{r=\"q\"} 8.5\nc_seconds_count{r=\"q\"} 4\n"
        "# HELP d Bare\n# TYPE d histogram\nd_bucket{le=\"1\"} 0\nd_bucket{le=\"+Inf\"} 1\nd_sum 2\nd_count "
        "1\n");
}

TEST_CASE("labels from outside cannot fill the memory") {
    Metrics metrics;
    for (int k = 0; k < 3000; ++k) metrics.counter("x_total", "X", {{"who", std::to_string(k)}}).add();
    const std::string text = metrics.text();
    REQUIRE(std::count(text.begin(), text.end(), '\n') == 2 + 1001);
    REQUIRE(text.find("x_total{other=\"true\"} 2000\n") != std::string::npos);
}

TEST_CASE("threads that count at once lose nothing") {
    Metrics metrics;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int k = 0; k < 5000; ++k) {
                metrics.counter("n_total", "N").add();
                metrics.gauge("g", "G").add(k % 2 == 0 ? 1 : -1);
            }
        });
    for (std::thread& thread : threads) thread.join();
    REQUIRE(metrics.counter("n_total", "N").value() == 20000);
    REQUIRE(metrics.gauge("g", "G").value() == 0);
}
