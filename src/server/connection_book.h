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
    std::size_t viewers = 128;      ///< of all, those that are WebSockets
};

/// The limits where a process may have so many descriptors open: a reserve stays for scenes, models and imports.
ConnectionLimits limits_for_descriptors(std::size_t descriptors);

/// Lets this process open as many descriptors as the system allows, and tells how many that are.
std::size_t raise_descriptor_limit();

/// Who is connected. Where a limit is reached the connection that has been idle for longest makes room; where none is
/// idle the newcomer is refused. Thread-safe; outlives its places.
class ConnectionBook {
public:
    explicit ConnectionBook(ConnectionLimits limits) : limits_(limits) {}
    ConnectionBook(const ConnectionBook&) = delete;
    ConnectionBook& operator=(const ConnectionBook&) = delete;

    /// A connection's entry; ends with it.
    class Place {
    public:
        Place(Place&& other) noexcept;
        Place& operator=(Place&&) = delete;
        ~Place();
        /// It waits for the client to ask. `give_up` closes it, to make room for another.
        void be_idle(std::function<void()> give_up);
        /// What the client asked for is in hand.
        void be_busy();
        /// Whether it may become a WebSocket; if so it counts as one from now on.
        [[nodiscard]] bool become_viewer();

    private:
        friend class ConnectionBook;
        Place(ConnectionBook& book, std::uint64_t number) : book_(&book), number_(number) {}
        ConnectionBook* book_;
        std::uint64_t number_;
    };

    /// Nothing where the limits refuse it.
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
