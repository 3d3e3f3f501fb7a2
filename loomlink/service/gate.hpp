#pragma once

#include <weave/net/throttle.hpp>

#include <loomlink/service/table.hpp>
#include <memory>

namespace weave::loomlink {

/// The cookie that keeps the page signed in.
inline constexpr const char* session_cookie = "loomlink";

/// The answer that says an error, with the status of its denial where it is one.
net::Response trouble_answer(const Error& error);

/// Who stands before the handlers: finds out who asks, whether the page or a stranger's page sends it,
/// whether the route is open to that person, and whether the request has the form that the table names.
class Gate {
  public:
    /// `refused` hears of what is refused to who is signed in; of others there is no word, so that nobody
    /// fills the log from outside. `strangers` is how often one address may use routes that are open to
    /// anyone and change something.
    Gate(FindSession find, NoteRefusal refused, const net::ThrottleRate& strangers);

    /// The route as the server takes it, answered by its handler. Error (system): it has none.
    [[nodiscard]] Result<net::Route> guarded(const ApiRoute& route, const ApiHandlers& handlers) const;

  private:
    class Keeper;
    std::shared_ptr<Keeper> m_keeper;
};

}  // namespace weave::loomlink
