#pragma once

#include <weave/net/websocket.hpp>

#include <functional>
#include <memory>
#include <string>

namespace weave::loomlink {

/// The terminals and pages that watch a loom, each on a WebSocket. Safe to use from any thread.
class Watchers {
  public:
    /// Whether the one who watches still may; asked before each message.
    using StillMay = std::function<bool()>;

    Watchers();

    /// Takes care of a new WebSocket to a loom.
    [[nodiscard]] std::unique_ptr<net::WebSocketHandler> watch(std::string loom, StillMay still_may) const;

    /// Tells all that watch this loom that its release index has changed: `{"loom", "changed": "index"}`. Who
    /// no longer may watch is sent away (1008).
    void tell(const std::string& loom) const;
    /// The same to all watchers of all looms, as after a new trust document.
    void tell_all() const;

  private:
    class List;
    class Handler;
    std::shared_ptr<List> m_list;
};

}  // namespace weave::loomlink
