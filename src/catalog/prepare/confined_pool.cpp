// SPDX-License-Identifier: MIT
#include "catalog/prepare/confined_pool.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <set>
#include <thread>
#include <utility>

#include "catalog/prepare/memory_budget.h"
#include "catalog/prepare/prepare.h"
#include "catalog/prepare/worker_process.h"

namespace embody::catalog {
namespace {

using Clock = WorkerProcess::Clock;

constexpr auto start_time = std::chrono::minutes(2);  // for a worker to load, confine itself and say so
constexpr int max_failed_starts = 3;
// Then a fresh worker takes over, so that leaks of libraries do not add up, and long before its own limit
// (ConfinementOptions::processor_seconds) ends it amid a model.
constexpr int models_a_worker = 256;
constexpr double max_processor_seconds = 1800;

std::filesystem::path worker_beside_this_program() {
    std::error_code problem;
    return std::filesystem::read_symlink("/proc/self/exe", problem).parent_path() / "embody-import-worker";
}

/// What the workers need to read: archives, and the folders of plain files. One folder that holds all of them where
/// they are too many for a program's arguments.
std::vector<std::string> places_of(const std::vector<ImportItem>& items) {
    constexpr std::size_t max_places = 256;
    std::set<std::string> places;
    for (const ImportItem& item : items) {
        const std::filesystem::path folder = std::filesystem::path(item.path).parent_path();
        places.insert(!item.archive.empty() ? item.archive : folder.empty() ? "." : folder.string());
    }
    if (places.size() <= max_places) return {places.begin(), places.end()};
    std::filesystem::path shared = *places.begin();
    for (const std::filesystem::path place : places) {
        const auto [end, other] = std::mismatch(shared.begin(), shared.end(), place.begin(), place.end());
        std::filesystem::path common;
        for (auto part = shared.begin(); part != end; ++part) common /= *part;
        shared = common;
    }
    return {shared.empty() ? "." : shared.string()};
}

std::string place_of(const ImportItem& item) {
    return item.archive.empty() ? item.path : item.archive + ": " + item.path;
}

std::string in_words(double seconds) {
    const auto whole = static_cast<long>(seconds);
    return static_cast<double>(whole) == seconds ? std::to_string(whole) : std::to_string(seconds);
}

/// Whether another try may end otherwise: errors that the file causes by itself repeat.
enum class Again : std::uint8_t { no, yes };

/// One import: a number of places, each with a worker or none, and the items in order; then one place for those that
/// are tried again.
class Pool {
public:
    using Done = std::function<bool(std::size_t, Result<PreparedModel>)>;

    Pool(const std::vector<ImportItem>& items, const ConfinedPoolOptions& options, const Done& done)
        : items_(items), options_(options), done_(done) {
        if (options_.worker_program.empty()) options_.worker_program = worker_beside_this_program();
        const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
        const std::size_t wanted = options_.workers > 0 ? static_cast<std::size_t>(options_.workers) : cores;
        memory_ = divide_memory(options_.bytes > 0 ? options_.bytes : default_memory_budget(), wanted);
    }

    Result<void> run() {
        readable_ = places_of(items_);
        queue_.resize(items_.size());
        std::iota(queue_.begin(), queue_.end(), std::size_t{0});
        places_.resize(std::min(memory_.workers, items_.size()));
        bytes_per_worker_ = memory_.each;
        if (auto ran = run_queue(); !ran) return ran;

        // Once more, alone, with all of the memory, and each by a worker of its own: one that lives on after a hostile
        // file may carry its damage into the next.
        queue_ = std::exchange(again_, {});
        next_ = 0;
        is_last_round_ = true;
        starts_in_vain_ = 0;
        places_.clear();
        places_.resize(std::min<std::size_t>(1, queue_.size()));
        bytes_per_worker_ = memory_.alone;
        return run_queue();
    }

private:
    struct Place {
        std::unique_ptr<WorkerProcess> worker;
        bool ready = false;
        bool has_item = false;
        std::size_t item = 0;
        int served = 0;
        double processor_seconds = 0;  ///< of the worker, when it was given the item
        Clock::time_point deadline;
    };

    Result<void> run_queue() {
        while (!stopped_ && (next_ < queue_.size() || is_busy())) {
            for (Place& place : places_) {
                if (place.worker == nullptr && next_ < queue_.size()) start(place);
            }
            if (starts_in_vain_ >= max_failed_starts && !any_was_ready_) return start_error_;
            // Workers that could start once and no longer can: what is left fails, by name.
            if (starts_in_vain_ >= max_failed_starts && !is_busy()) {
                finish_item(queue_[next_++], start_error_);
                continue;
            }
            wait_and_serve();
        }
        return {};
    }

    [[nodiscard]] bool is_busy() const {
        return std::any_of(places_.begin(), places_.end(), [](const Place& p) { return p.has_item; });
    }

    void start(Place& place) {
        auto worker = WorkerProcess::start(options_.worker_program, bytes_per_worker_, readable_);
        if (!worker) {
            ++starts_in_vain_;
            start_error_ = worker.error();
            return;
        }
        place = Place{};
        place.worker = std::make_unique<WorkerProcess>(std::move(*worker));
        if (options_.in_background) place.worker->lower_priority();
        place.deadline = Clock::now() + start_time;
    }

    void wait_and_serve() {
        // Until a worker speaks, can take more, or is due.
        std::vector<pollfd> waits;
        auto due = Clock::now() + std::chrono::seconds(1);
        for (const Place& place : places_) {
            if (place.worker == nullptr) continue;
            waits.push_back({place.worker->output(), POLLIN, 0});
            if (place.worker->has_unsent()) waits.push_back({place.worker->input(), POLLOUT, 0});
            due = std::min({due, place.deadline, Clock::now() + seconds(processor_seconds_left(place))});
        }
        if (options_.go_on && !options_.go_on()) stopped_ = true;
        if (waits.empty() || stopped_) return;
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - Clock::now()).count();
        poll(waits.data(), waits.size(), static_cast<int>(std::clamp<std::int64_t>(left, 0, 1000)));

        // Results before deadlines: a slow `done` is not the worker's fault.
        for (Place& place : places_) {
            if (place.worker == nullptr || stopped_) continue;
            place.worker->send_some();
            const bool open = place.worker->receive_some();
            if (!take_messages(place)) continue;
            if (!open) {
                lose(place, "the import worker " + place.worker->finish() + " while reading it", Again::yes);
            } else if (place.has_item && processor_seconds_left(place) <= 0) {
                const std::string limit = in_words(options_.processor_seconds_per_model);
                lose(place, "needs more than " + limit + " s of processor time", Again::no);
            } else if (Clock::now() >= place.deadline && (place.has_item || !place.ready)) {
                lose(place, "was not ready within " + in_words(options_.wall_seconds_per_model) + " s", Again::yes);
            }
        }
    }

    static Clock::duration seconds(double number) {
        return std::chrono::ceil<Clock::duration>(std::chrono::duration<double>(number));
    }

    [[nodiscard]] double processor_seconds_left(const Place& place) const {
        if (!place.has_item) return options_.processor_seconds_per_model;
        const double used = place.worker->processor_seconds() - place.processor_seconds;
        return options_.processor_seconds_per_model - used;
    }

    /// False where the place lost its worker or changed its item, so that what was seen before no longer counts.
    bool take_messages(Place& place) {
        auto message = place.worker->take_message();
        if (!message) {
            lose(place, message.error().why, Again::no);
            return false;
        }
        if (!message->has_value()) return true;
        if ((*message)->kind == FrameKind::ready && !place.ready) {
            place.ready = any_was_ready_ = true;
            starts_in_vain_ = 0;
            assign_next(place);
        } else if (place.has_item &&
                   ((*message)->kind == FrameKind::prepared || (*message)->kind == FrameKind::failed ||
                    (*message)->kind == FrameKind::out_of_memory)) {
            take_answer(place, **message);
        } else {
            lose(place, "the import worker spoke out of turn", Again::no);
        }
        return false;
    }

    void take_answer(Place& place, const WorkerProcess::Message& message) {
        Result<PreparedModel> result = error_from_bytes(message.payload);
        if (message.kind == FrameKind::prepared) result = model_from_bytes(message.payload);
        // The worker answers for the geometry only; what the catalogue stated is taken from the item itself.
        const ImportItem& item = items_[place.item];
        if (result) {
            attributes::ModelFacts facts = stated_facts(item);
            facts.material_names = std::move(result->facts.material_names);
            facts.geometry = std::move(result->facts.geometry);
            result->facts = std::move(facts);
        }
        const std::size_t answered = place.item;
        place.has_item = false;
        ++place.served;
        // Work for the worker first, so that it is busy while `done` stores the model.
        const bool gets_more_memory = message.kind == FrameKind::out_of_memory && memory_.alone > bytes_per_worker_;
        const bool is_used_up = is_last_round_ || place.served >= models_a_worker;
        if (is_used_up || place.worker->processor_seconds() > max_processor_seconds) {
            place.worker.reset();
        } else {
            assign_next(place);
        }
        finish_item(answered, std::move(result), gets_more_memory ? Again::yes : Again::no);
    }

    void assign_next(Place& place) {
        while (next_ < queue_.size()) {
            const std::size_t number = queue_[next_++];
            std::vector<std::uint8_t> payload = to_bytes(items_[number]);
            // Items that the worker would refuse to read are refused here.
            if (const auto readable = item_from_bytes(payload); !readable) {
                finish_item(number, readable.error());
                if (stopped_) return;
                continue;
            }
            place.item = number;
            place.has_item = true;
            place.processor_seconds = place.worker->processor_seconds();
            place.deadline = Clock::now() + seconds(options_.wall_seconds_per_model);
            place.worker->queue(frame(FrameKind::item, payload));
            place.worker->send_some();
            return;
        }
        // Nothing left to do: it may go.
        place.worker.reset();
    }

    /// Ends a place's worker; the item it had fails with `why`.
    void lose(Place& place, const std::string& why, Again again) {
        if (!place.ready) {
            ++starts_in_vain_;
            start_error_ =
                Error{options_.worker_program.string(), "did not start: the import worker " + place.worker->finish()};
        }
        place.worker.reset();
        if (!place.has_item) return;
        place.has_item = false;
        finish_item(place.item, Error{place_of(items_[place.item]), why}, again);
    }

    void finish_item(std::size_t item, Result<PreparedModel> result, Again again = Again::no) {
        if (again == Again::yes && !is_last_round_) {
            again_.push_back(item);
        } else if (!stopped_ && !done_(item, std::move(result))) {
            stopped_ = true;
        }
    }

    const std::vector<ImportItem>& items_;
    ConfinedPoolOptions options_;
    const Done& done_;
    WorkerMemory memory_;
    std::size_t bytes_per_worker_ = 0;
    std::vector<std::string> readable_;  // by the workers
    std::vector<Place> places_;
    std::vector<std::size_t> queue_, again_;  // items of this pass, and of the next
    std::size_t next_ = 0;                    // in the queue
    bool stopped_ = false, any_was_ready_ = false, is_last_round_ = false;
    int starts_in_vain_ = 0;
    Error start_error_;
};

}  // namespace

Result<void> prepare_confined(const std::vector<ImportItem>& items, const ConfinedPoolOptions& options,
                              const std::function<bool(std::size_t item, Result<PreparedModel> prepared)>& done) {
    const auto is_in_range = [](double seconds, double max_seconds) { return seconds > 0 && seconds <= max_seconds; };
    if (!is_in_range(options.processor_seconds_per_model, max_processor_seconds)) {
        return Error{"processor_seconds_per_model", "must be greater than 0 s and at most 1800 s"};
    }
    if (!is_in_range(options.wall_seconds_per_model, 1e6)) {
        return Error{"wall_seconds_per_model", "must be greater than 0 s and at most 1e6 s"};
    }
    return Pool(items, options, done).run();
}

}  // namespace embody::catalog
