// Blocks that are made beside the window's thread, where memory ends.

#include <weave/core/instrumented.hpp>
#include <weave/samples/samples.hpp>

#include <QtTest>

#include <catch2/catch.hpp>
#include <fstream>
#include <studio/document/cloth_maker.hpp>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

using namespace weave;
using namespace weave::studio;

namespace {

/// While it lives the program may have so many bytes more than it has now, and is refused all others.
class LittleMemory {
  public:
    explicit LittleMemory(rlim_t more) {
        getrlimit(RLIMIT_AS, &m_before);
        rlim_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlimit little{pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more, m_before.rlim_max};
        REQUIRE(setrlimit(RLIMIT_AS, &little) == 0);
    }
    ~LittleMemory() { setrlimit(RLIMIT_AS, &m_before); }
    LittleMemory(const LittleMemory&) = delete;
    LittleMemory& operator=(const LittleMemory&) = delete;

  private:
    rlimit m_before{};
};

Design repeated(std::size_t times) {
    Design design = find_sample("plain")->make();
    design.blocks["large"] = std::make_shared<const Node>(Node{TileOperation{design.root, times, times, 1}, {}});
    design.root = "large";
    return design;
}

}  // namespace

TEST_CASE("a block that memory does not do for is told as such, and the next is made") {
    if constexpr (is_instrumented) return;  // whose own memory would be refused
    ClothMaker maker;
    std::vector<Cloth> told;
    QObject::connect(&maker, &ClothMaker::made, &maker, [&](const QString& block, const Cloth& cloth) {
        if (block == "large") told.push_back(cloth);
    });
    {
        const LittleMemory little(rlim_t{128} << 20);
        maker.make(repeated(8000), 1, "large");  // a gigabyte of cells
        REQUIRE(QTest::qWaitFor([&] { return !told.empty(); }, 60'000));
    }
    CHECK_FALSE(told.back().block);
    REQUIRE(told.back().error);
    CHECK(told.back().error->text() == "blocks.large: there is not enough memory to make this block");
    maker.make(repeated(4), 2, "large");
    REQUIRE(QTest::qWaitFor([&] { return told.back().revision == 2; }, 60'000));
    REQUIRE(told.back().block);
    CHECK(told.back().block->picks() == 8);
}
