#include <loomlink/workflow/workflow.hpp>

namespace weave::loomlink {

Workflow::Workflow(Store store, ServerKeys keys, std::string site, const DeskSettings& settings,
                   NowClock clock)
    : m_desk(std::move(store), std::move(keys), std::move(site), settings, std::move(clock)) {}

Result<std::unique_ptr<Workflow>> Workflow::open(Store store, ServerKeys keys, const DeskSettings& settings,
                                                 NowClock clock) {
    WEAVE_TRY(std::string site, store.read([](const Reader& reader) { return reader.site(); }));
    return std::unique_ptr<Workflow>(
        new Workflow(std::move(store), std::move(keys), std::move(site), settings, std::move(clock)));
}

}  // namespace weave::loomlink
