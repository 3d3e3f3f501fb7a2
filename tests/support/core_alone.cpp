// Links the static core and nothing else: fails to build when the core comes to need a library.

#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/loom/pick_table.hpp>
#include <weave/samples/samples.hpp>

#include <cstdio>

int main() {
    for (const weave::Sample& sample : weave::samples()) {
        const weave::Design design = sample.make();
        const auto cloth = weave::evaluate(design);
        if (!cloth || weave::pick_table(design, *cloth->block).size() != cloth->block->picks()) {
            std::printf("sample %s does not weave\n", sample.name.c_str());
            return 1;
        }
    }
    return 0;
}
