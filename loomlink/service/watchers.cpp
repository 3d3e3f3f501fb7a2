#include <loomlink/service/watchers.hpp>

#include <weave/core/json.hpp>

#include <algorithm>
#include <mutex>
#include <vector>

namespace weave::loomlink {

namespace {

constexpr std::uint16_t not_allowed = 1008;  // RFC 6455: violates the policy

struct Watcher {
    std::string loom;
    Watchers::StillMay still_may;
    std::shared_ptr<net::WebSocket> socket;
};

void tell_one(const Watcher& watcher) {
    if (!watcher.still_may()) return watcher.socket->close(not_allowed, "you may no longer watch this loom");
    watcher.socket->send_control(net::make_bytes(Json{{"loom", watcher.loom}, {"changed", "index"}}.dump()));
}

}  // namespace

class Watchers::List {
  public:
    void add(const std::shared_ptr<Watcher>& watcher) {
        const std::lock_guard lock(m_mutex);
        m_all.push_back(watcher);
    }
    void remove(const std::shared_ptr<Watcher>& watcher) {
        const std::lock_guard lock(m_mutex);
        std::erase(m_all, watcher);
    }
    [[nodiscard]] std::vector<std::shared_ptr<Watcher>> all() const {
        const std::lock_guard lock(m_mutex);
        return m_all;
    }

  private:
    mutable std::mutex m_mutex;
    std::vector<std::shared_ptr<Watcher>> m_all;
};

class Watchers::Handler : public net::WebSocketHandler {
  public:
    Handler(std::shared_ptr<List> list, std::string loom, StillMay still_may)
        : m_list(std::move(list)),
          m_watcher(std::make_shared<Watcher>(Watcher{std::move(loom), std::move(still_may), nullptr})) {}
    ~Handler() override { m_list->remove(m_watcher); }
    Handler(const Handler&) = delete;
    Handler& operator=(const Handler&) = delete;

    void opened(std::shared_ptr<net::WebSocket> socket) override {
        m_watcher->socket = std::move(socket);
        m_list->add(m_watcher);
    }
    void message(net::WebSocketMessage) override {
        m_watcher->socket->close(not_allowed, "nothing can be asked here");
    }
    void closed(const net::WebSocketEnd&) override { m_list->remove(m_watcher); }

  private:
    std::shared_ptr<List> m_list;
    std::shared_ptr<Watcher> m_watcher;
};

Watchers::Watchers() : m_list(std::make_shared<List>()) {}

std::unique_ptr<net::WebSocketHandler> Watchers::watch(std::string loom, StillMay still_may) const {
    return std::make_unique<Handler>(m_list, std::move(loom), std::move(still_may));
}

void Watchers::tell(const std::string& loom) const {
    for (const auto& watcher : m_list->all())
        if (watcher->loom == loom) tell_one(*watcher);
}

void Watchers::tell_all() const {
    for (const auto& watcher : m_list->all()) tell_one(*watcher);
}

}  // namespace weave::loomlink
