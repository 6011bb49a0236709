// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace embody::server {

/// How many connections may be open at once.
struct ConnectionLimits {
    std::size_t all = 512;
    std::size_t per_address = 256;  ///< of one client's address
    std::size_t viewers = 128;      ///< WebSockets, of all addresses
};

/// The limits of a process that may have so many descriptors open; some descriptors stay reserved for scenes, models
/// and imports.
ConnectionLimits limits_for_descriptors(std::size_t descriptors);

/// Raises this process's limit of open descriptors as far as the system allows, and returns the new limit.
std::size_t raise_descriptor_limit();

/// Counts the connections. Where a limit is reached, the connection that has been idle for longest is closed; where
/// none is idle, the new connection is refused. Thread-safe; outlives its places.
class ConnectionBook {
public:
    explicit ConnectionBook(ConnectionLimits limits) : limits_(limits) {}
    ConnectionBook(const ConnectionBook&) = delete;
    ConnectionBook& operator=(const ConnectionBook&) = delete;

    /// A connection's entry, removed with this object.
    class Place {
    public:
        Place(Place&& other) noexcept;
        Place& operator=(Place&&) = delete;
        ~Place();
        /// The connection waits for the client's next request. `give_up` closes it, to make room for another.
        void be_idle(std::function<void()> give_up);
        /// A request of the client is being answered.
        void be_busy();
        /// Whether the connection may become a WebSocket; if so, it counts as one from now on.
        [[nodiscard]] bool become_viewer();

    private:
        friend class ConnectionBook;
        Place(ConnectionBook& book, std::uint64_t number) : book_(&book), number_(number) {}
        ConnectionBook* book_;
        std::uint64_t number_;
    };

    /// Empty where the limits refuse the connection.
    [[nodiscard]] std::optional<Place> admit(const std::string& address);

private:
    struct Entry {
        std::string address;
        std::uint64_t idle_since = 0;  ///< 0: busy; else a number that grows with time
        std::function<void()> give_up;
        bool is_viewer = false;
    };
    // Under the mutex, like all below.
    using Entries = std::map<std::uint64_t, Entry>;
    [[nodiscard]] Entries::iterator idlest(const std::string* address);
    void remove(Entries::iterator entry);

    std::mutex mutex_;
    ConnectionLimits limits_;
    Entries entries_;
    std::map<std::string, std::size_t> of_address_;
    std::size_t viewers_ = 0;
    std::uint64_t next_number_ = 1, clock_ = 0;
};

}  // namespace embody::server
