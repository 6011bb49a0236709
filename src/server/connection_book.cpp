// SPDX-License-Identifier: MIT
#include "server/connection_book.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace embody::server {
namespace {

/// Descriptors for the scene's files, the database in each thread that has it open, uploads, import workers and their
/// pipes.
constexpr std::size_t reserved_descriptors = 128;
constexpr std::size_t fewest_connections = 8;
/// More than a server of 512 connections ever needs; some systems allow 10⁹.
constexpr rlim_t enough_descriptors = 4096;

}  // namespace

ConnectionLimits limits_for_descriptors(std::size_t descriptors) {
    ConnectionLimits limits;
    const std::size_t left = descriptors > reserved_descriptors ? descriptors - reserved_descriptors : 0;
    limits.all = std::clamp(left, fewest_connections, limits.all);
    limits.per_address = std::min(limits.per_address, std::max(fewest_connections, limits.all / 2));
    limits.viewers = std::min(limits.viewers, std::max(fewest_connections / 2, limits.all / 4));
    return limits;
}

std::size_t raise_descriptor_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
    rlimit raised = limit;
    raised.rlim_cur = std::max(limit.rlim_cur, std::min(limit.rlim_max, enough_descriptors));
    // Where the system refuses to raise the limit, the present limit holds.
    if (setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
    return static_cast<std::size_t>(std::min<rlim_t>(limit.rlim_cur, enough_descriptors));
}

ConnectionBook::Place::Place(Place&& other) noexcept
    : book_(std::exchange(other.book_, nullptr)), number_(other.number_) {}

ConnectionBook::Place::~Place() {
    if (book_ == nullptr) return;
    const std::lock_guard lock(book_->mutex_);
    const auto entry = book_->entries_.find(number_);
    if (entry != book_->entries_.end()) book_->remove(entry);
}

// A connection that had to make room has no entry any more.
void ConnectionBook::Place::be_idle(std::function<void()> give_up) {
    const std::lock_guard lock(book_->mutex_);
    const auto entry = book_->entries_.find(number_);
    if (entry == book_->entries_.end()) return;
    entry->second.idle_since = ++book_->clock_;
    entry->second.give_up = std::move(give_up);
}

void ConnectionBook::Place::be_busy() {
    const std::lock_guard lock(book_->mutex_);
    const auto entry = book_->entries_.find(number_);
    if (entry == book_->entries_.end()) return;
    entry->second.idle_since = 0;
    entry->second.give_up = nullptr;
}

bool ConnectionBook::Place::become_viewer() {
    const std::lock_guard lock(book_->mutex_);
    const auto entry = book_->entries_.find(number_);
    if (entry == book_->entries_.end() || book_->viewers_ >= book_->limits_.viewers) return false;
    ++book_->viewers_;
    return entry->second.is_viewer = true;
}

std::optional<ConnectionBook::Place> ConnectionBook::admit(const std::string& address) {
    std::function<void()> give_up;
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(mutex_);
        const auto of_same = of_address_.find(address);
        const bool are_many_of_same = of_same != of_address_.end() && of_same->second >= limits_.per_address;
        if (are_many_of_same || entries_.size() >= limits_.all) {
            const auto entry = idlest(are_many_of_same ? &address : nullptr);
            if (entry == entries_.end()) return std::nullopt;
            give_up = std::move(entry->second.give_up);
            remove(entry);
        }
        number = next_number_++;
        entries_[number].address = address;
        ++of_address_[address];
    }
    if (give_up) give_up();
    return Place(*this, number);
}

// The connection that has been idle for longest, of this address or of any; the end where none is idle.
ConnectionBook::Entries::iterator ConnectionBook::idlest(const std::string* address) {
    auto found = entries_.end();
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (entry->second.idle_since == 0 || (address != nullptr && entry->second.address != *address)) continue;
        if (found == entries_.end() || entry->second.idle_since < found->second.idle_since) found = entry;
    }
    return found;
}

void ConnectionBook::remove(Entries::iterator entry) {
    const auto count = of_address_.find(entry->second.address);
    if (--count->second == 0) of_address_.erase(count);
    if (entry->second.is_viewer) --viewers_;
    entries_.erase(entry);
}

}  // namespace embody::server
