#include "flip_one.hpp"
#include "loomlink.hpp"
#include "loomlink_site.hpp"

#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>

namespace weave::bench {

Json loomlink_growth() {
    constexpr int saves = 20;
    LoomlinkSite site;
    auto dora = site.join("dora", "designer");
    dora.done("POST", "/designs", {{"name", "shoe"}});
    const std::uintmax_t empty = site.stop_and_measure();
    const auto save = [&](const std::string& document, int expected) {
        Json body{{"document", document}, {"branch", "main"}, {"message", "one more"}};
        if (expected > 0) body["expected"] = expected;
        site.again("dora").done("POST", "/designs/shoe/revisions", body);
    };
    Design design = find_sample("shoe-adult")->make();
    const std::string first = write_document(design);
    site.start();
    save(first, 0);
    const std::uintmax_t with_shoe = site.stop_and_measure();
    site.start();
    for (int k = 1; k <= saves; ++k) {
        flip_one(design, static_cast<std::size_t>(k));
        save(write_document(design), k);
    }
    const std::uintmax_t after = site.stop_and_measure();
    return {{"document_bytes", first.size()},
            {"edited_document_bytes", write_document(design).size()},
            {"first_save_bytes", with_shoe - empty},
            {"edits", saves},
            {"bytes_an_edit", static_cast<double>(after - with_shoe) / saves}};
}

}  // namespace weave::bench
