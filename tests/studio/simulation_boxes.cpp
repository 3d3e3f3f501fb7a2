// What waits between the window's thread and a computing one.

#include <weave/design/scene.hpp>

#include <catch2/catch.hpp>

#include <QCoreApplication>
#include <QObject>

#include <studio/jobs/inbox.hpp>
#include <studio/jobs/outbox.hpp>
#include <thread>

using namespace weave;
using namespace weave::studio;

namespace {

Happening frame(std::uint64_t number) {
    auto one = std::make_shared<Frame>();
    one->head.number = number;
    return std::shared_ptr<const Frame>(one);
}

Progress progress(std::uint64_t step) {
    Progress one;
    one.step = step;
    one.history = {{step, 1.0 / static_cast<double>(step)}};
    return one;
}

}  // namespace

TEST_CASE("frames never queue up for a window that is slow") {
    Outbox box;
    QObject window;
    std::vector<Happening> came;
    int calls = 0;
    box.open(&window, [&] {
        ++calls;
        for (Happening& one : box.take()) came.push_back(std::move(one));
    });
    std::thread worker([&] {
        for (std::uint64_t k = 1; k <= 1000; ++k) {
            box.tell(progress(k));
            box.tell(frame(k));
        }
    });
    worker.join();
    QCoreApplication::processEvents();
    CHECK(calls == 1);
    REQUIRE(came.size() == 2);
    CHECK(std::get<Progress>(came[0]).step == 1000);
    CHECK(std::get<Progress>(came[0]).history.size() == 1000);  // the curve has no gap
    CHECK(std::get<std::shared_ptr<const Frame>>(came[1])->head.number == 1000);
}

TEST_CASE("the curve of a run that nobody looks at for long is thinned out") {
    Outbox box;
    QObject window;
    box.open(&window, [] {});
    for (std::uint64_t k = 1; k <= 20'000; ++k) box.tell(progress(k));
    const std::vector<Happening> came = box.take();
    REQUIRE(came.size() == 1);
    const auto& history = std::get<Progress>(came[0]).history;
    CHECK(history.size() <= 4096);
    CHECK(history.front().step == 1);
    CHECK(history.back().step > 19'990);
}

TEST_CASE("what happened is told in its order, each phase, and frames behind their layouts") {
    Outbox box;
    QObject window;
    box.open(&window, [] {});
    box.tell(RunPhase::paused);
    box.tell(frame(1));
    box.tell(std::make_shared<const YarnLayout>());
    box.tell(RunPhase::running);
    box.tell(frame(2));
    box.tell(RunPhase::at_rest);
    const std::vector<Happening> came = box.take();
    REQUIRE(came.size() == 5);
    CHECK(std::get<RunPhase>(came[0]) == RunPhase::paused);
    CHECK(std::holds_alternative<std::shared_ptr<const YarnLayout>>(came[1]));
    CHECK(std::get<std::shared_ptr<const Frame>>(came[3])->head.number == 2);
    CHECK(std::get<RunPhase>(came[4]) == RunPhase::at_rest);
    box.close();
    box.tell(frame(3));
    CHECK(box.take().empty());
}

TEST_CASE("values of a slider that is dragged wait as one, and never pass a flip by") {
    Inbox box;
    const auto strain = [](double value) {
        return SystemScene{.strain = value, .stiffness_scale = {}, .radius_scale = {}};
    };
    box.order(wire::Parameters{strain(1.01), {}});
    box.order(wire::Parameters{{}, strain(1.02)});
    box.order(wire::Parameters{strain(1.03), {}});
    box.order(Flip{1, 2, true});
    box.order(wire::Parameters{strain(1.04), {}});
    box.order(RunOrder{});
    const std::deque<Order> orders = box.take();
    REQUIRE(orders.size() == 4);
    CHECK(std::get<wire::Parameters>(orders[0]).warp == strain(1.03));
    CHECK(std::get<wire::Parameters>(orders[0]).weft == strain(1.02));
    CHECK(std::get<wire::Parameters>(orders[2]).warp == strain(1.04));
    box.finish(Finish::leave);
    box.finish(Finish::report);
    CHECK(box.finish() == Finish::leave);
    box.wait();  // returns at once
}
