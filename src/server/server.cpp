// SPDX-License-Identifier: MIT
//
// The transport. This file is longer than others because it is the only one that includes Boost.Beast, which takes most
// of this layer's compile time. One network thread runs the io_context and never waits: the scene has its own thread
// (scene_thread.h), and so have imports; work queues read the database, the scene and files, and post the answers back.
#include "server/server.h"

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdio>
#include <deque>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include "foundation/printable.h"
#include "server/access.h"
#include "server/certificate.h"
#include "server/connection_book.h"
#include "server/import_request.h"
#include "server/lan_addresses.h"
#include "server/library_fill.h"
#include "server/routes.h"
#include "server/upload_store.h"
#include "server/work_queue.h"

namespace embody::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using beast::error_code;
using Clock = std::chrono::steady_clock;

/// A connection that sends no request, or does not complete one, for this time is closed.
constexpr auto longest_silence = std::chrono::seconds(30);
/// An upload ends after so long without new bytes, or so long in all.
constexpr auto longest_stall = std::chrono::seconds(20);
constexpr auto longest_upload = std::chrono::minutes(10);
constexpr auto longest_answer = std::chrono::minutes(2);  ///< until the client has read the answer
/// A viewer that does not answer a ping for two of these periods has gone.
constexpr auto viewer_watch_period = std::chrono::seconds(150);

/// After a failed accept(), mostly for lack of descriptors: the pause, and the period of messages about it.
constexpr auto accept_pause = std::chrono::milliseconds(100);
constexpr auto accept_failure_period = std::chrono::seconds(10);

/// Each thread has the database open, so that reading a large model does not delay other requests.
constexpr std::size_t route_threads = 2;

constexpr std::uint64_t largest_other_body = 64 << 10;
constexpr std::size_t piece_bytes = 64 << 10;  ///< size of the pieces of an upload, from the socket to the file
constexpr std::size_t largest_command = std::size_t{64} << 20;  ///< a whole scene may arrive as one command
/// Bytes that wait behind the message being sent to one client; a client that reads nothing is disconnected.
constexpr std::size_t most_unsent_text = std::size_t{256} << 20;
/// Limits of one client: commands that wait for their reply, and replies that it has not read. Its next commands stay
/// in the socket until there are fewer, so that a flood of commands does not fill the memory.
constexpr std::size_t most_waiting_commands = 256;
constexpr std::size_t most_waiting_bytes = largest_command;
constexpr std::size_t most_unread_replies = std::size_t{1} << 20;
/// Bytes of all clients' commands that wait or are being received; a client that sends more is disconnected.
constexpr std::size_t most_command_bytes = std::size_t{512} << 20;

class WebSocketClient;

/// State that connections share; lives as long as the server, which outlives them.
struct Shared {
    ConnectionBook connections{limits_for_descriptors(raise_descriptor_limit())};
    std::map<ClientId, std::shared_ptr<WebSocketClient>> clients;  ///< keeps clients alive that are not being read
    ClientId next_client = 1;
    std::size_t command_bytes = 0;
    asio::io_context io;
    AccessRules access;
    std::unique_ptr<asio::ssl::context> tls;  ///< null: plain HTTP
    std::unique_ptr<SceneThread> scene;
    std::shared_ptr<UploadStore> uploads;
    std::unique_ptr<Routes> routes;
    std::unique_ptr<WorkQueue> route_queue, upload_queue;
    std::unique_ptr<ImportRequests> imports;
    std::unique_ptr<LibraryFill> fill;
};

void report_failure(const std::exception& thrown) {
    std::fprintf(stderr, "embody: a connection failed: %s\n", printable(thrown.what()).c_str());
}

// ---------------------------------------------------------------------------------------------------------------------------
// A TCP connection with or without TLS: one type, so that Beast's HTTP and WebSocket are compiled once for both.

class Stream {
public:
    using executor_type = beast::tcp_stream::executor_type;
    using next_layer_type = beast::tcp_stream;  ///< by this name Beast finds the layer that has time limits

    explicit Stream(tcp::socket&& socket) : layers_(std::make_unique<Layers>(std::move(socket))) {}

    executor_type get_executor() { return layers_->plain.get_executor(); }
    beast::tcp_stream& next_layer() { return layers_->plain; }
    [[nodiscard]] const beast::tcp_stream& next_layer() const { return layers_->plain; }

    /// What was read before is the beginning of the client's part.
    template <class Buffers, class Handler>
    void begin_tls(asio::ssl::context& context, const Buffers& read_before, Handler&& handler) {
        layers_->tls.emplace(layers_->plain, context);
        layers_->tls->async_handshake(asio::ssl::stream_base::server, read_before, std::forward<Handler>(handler));
    }
    [[nodiscard]] bool has_tls() const { return layers_->tls.has_value(); }

    template <class Buffers, class Token>
    auto async_read_some(const Buffers& buffers, Token&& token) {
        return asio::async_initiate<Token, void(error_code, std::size_t)>(
            [layers = layers_.get()](auto handler, const Buffers& into) {
                if (layers->tls)
                    layers->tls->async_read_some(into, std::move(handler));
                else
                    layers->plain.async_read_some(into, std::move(handler));
            },
            token, buffers);
    }
    template <class Buffers, class Token>
    auto async_write_some(const Buffers& buffers, Token&& token) {
        return asio::async_initiate<Token, void(error_code, std::size_t)>(
            [layers = layers_.get()](auto handler, const Buffers& from) {
                if (layers->tls)
                    layers->tls->async_write_some(from, std::move(handler));
                else
                    layers->plain.async_write_some(from, std::move(handler));
            },
            token, buffers);
    }

private:
    struct Layers {
        explicit Layers(tcp::socket&& socket) : plain(std::move(socket)) {}
        beast::tcp_stream plain;
        std::optional<asio::ssl::stream<beast::tcp_stream&>> tls;
    };
    std::unique_ptr<Layers> layers_;  ///< stays where it is, since TLS refers to the connection
};

/// The end of a WebSocket: its close frames were exchanged, so that only the connection is left to be closed.
template <class Handler>
void async_teardown(beast::role_type role, Stream& stream, Handler&& handler) {
    beast::async_teardown(role, stream.next_layer(), std::forward<Handler>(handler));
}

// ---------------------------------------------------------------------------------------------------------------------------
// A browser or script that is connected by WebSocket.

using SharedText = std::shared_ptr<const std::string>;

class WebSocketClient : public std::enable_shared_from_this<WebSocketClient> {
public:
    WebSocketClient(Stream&& stream, Shared& shared, ConnectionBook::Place place, scene::Rights rights)
        : stream_(std::move(stream)),
          shared_(shared),
          place_(std::move(place)),
          id_(shared.next_client++),
          rights_(rights),
          watch_(shared.io) {}
    WebSocketClient(const WebSocketClient&) = delete;
    WebSocketClient& operator=(const WebSocketClient&) = delete;
    ~WebSocketClient() { shared_.command_bytes -= held_bytes_; }

    void accept(const http::request<http::empty_body>& request) {
        // Beast's own idle timeout would close a client that is not read for a while; watch() does not.
        websocket::stream_base::timeout timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
        timeout.idle_timeout = websocket::stream_base::none();
        timeout.keep_alive_pings = false;
        stream_.set_option(timeout);
        stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
            for (const auto& [name, value] : protective_headers()) response.set(name, value);
        }));
        stream_.control_callback([this](websocket::frame_type, beast::string_view) { was_heard_ = true; });
        stream_.read_message_max(largest_command);
        stream_.auto_fragment(false);
        stream_.async_accept(request, [self = shared_from_this()](error_code error) {
            if (error) return;
            self->shared_.clients[self->id_] = self;
            self->shared_.scene->admit(self->id_, self->rights_);
            self->guarded([&] {
                self->read();
                self->send_frame();
                self->watch();
            });
        });
    }

    void send_text(SharedText text) {
        guarded([&] {
            // The limit does not count the message being sent, so a first one of any size is accepted.
            if (!texts_.empty() && unsent_ + text->size() > most_unsent_text) return close();
            unsent_ += text->size();
            texts_.push_back(std::move(text));
            write();
        });
    }

    /// Sends the newest states as soon as nothing else is being written.
    void send_frame() {
        guarded([&] {
            frame_wanted_ = true;
            write();
        });
    }

    void send_reply(std::string text) {
        guarded([&] {
            let_go_of(waiting_.front());
            waiting_bytes_ -= waiting_.front();
            waiting_.pop_front();
            send_text(std::make_shared<const std::string>(std::move(text)));
            read_on();
        });
    }

    void close() {
        error_code ignored;
        beast::get_lowest_layer(stream_).socket().close(ignored);
        leave();
    }

private:
    /// An exception (memory) ends this client and nothing else.
    template <class Work>
    void guarded(const Work& work) {
        try {
            work();
        } catch (const std::exception& thrown) {
            report_failure(thrown);
            close();
        }
    }

    // The caller holds the client by another pointer than that of the map.
    void leave() {
        watch_.cancel();
        if (shared_.clients.erase(id_) > 0) shared_.scene->forget(id_);
    }

    // Pings the client from time to time, except while it is not being read, because its answer would not be read
    // either.
    void watch() {
        watch_.expires_after(viewer_watch_period);
        watch_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (error || !self) return;
            const bool was_heard = std::exchange(self->was_heard_, false) || self->read_pauses_;
            self->silent_periods_ = was_heard ? 0 : self->silent_periods_ + 1;
            if (self->silent_periods_ >= 2) return self->close();
            self->guarded([&] {
                self->ping();
                self->watch();
            });
        });
    }
    void ping() {
        if (std::exchange(is_pinging_, true)) return;
        stream_.async_ping({}, [self = shared_from_this()](error_code) { self->is_pinging_ = false; });
    }

    [[nodiscard]] bool has_enough_waiting() const {
        return waiting_.size() >= most_waiting_commands || waiting_bytes_ >= most_waiting_bytes ||
               unsent_ >= most_unread_replies;
    }
    void read_on() {
        if (read_pauses_ && !has_enough_waiting()) read();
    }

    void read() {
        read_pauses_ = false;
        stream_.async_read_some(buffer_, largest_command,
                                [self = shared_from_this()](error_code error, std::size_t size) {
                                    if (error) return self->leave();
                                    self->guarded([&] { self->take(size); });
                                });
    }

    // Receives a part of a message, or its last one.
    void take(std::size_t size) {
        was_heard_ = true;
        held_bytes_ += size;
        shared_.command_bytes += size;
        if (shared_.command_bytes > most_command_bytes) return close();
        if (!stream_.is_message_done()) return read();
        waiting_.push_back(buffer_.size());
        waiting_bytes_ += buffer_.size();
        shared_.scene->post(id_, beast::buffers_to_string(buffer_.data()));
        buffer_.consume(buffer_.size());
        if (buffer_.capacity() > most_unread_replies) buffer_.shrink_to_fit();
        read_pauses_ = has_enough_waiting();
        if (!read_pauses_) read();
    }

    void let_go_of(std::size_t bytes) {
        held_bytes_ -= bytes;
        shared_.command_bytes -= bytes;
    }

    // The newest states, or the newest debug frame; null: nothing new.
    SharedText next_frame() {
        if (std::exchange(frame_wanted_, false)) {
            StateBoard::Frame frame = shared_.scene->frame_since(seen_);
            seen_ = frame.version;
            if (!frame.bytes.empty()) return std::make_shared<const std::string>(std::move(frame.bytes));
        }
        return shared_.scene->take_debug_frame(id_);
    }

    // One write at a time: texts in order; frames only when no text waits, and always the newest states.
    void write() {
        if (outgoing_) return;
        if (!texts_.empty()) {
            outgoing_ = std::move(texts_.front());
            texts_.pop_front();
            unsent_ -= outgoing_->size();
            stream_.text(true);
        } else {
            outgoing_ = next_frame();
            if (!outgoing_) return;
            stream_.binary(true);
        }
        stream_.async_write(asio::buffer(*outgoing_), [self = shared_from_this()](error_code error, std::size_t) {
            self->outgoing_ = nullptr;
            if (error) return self->leave();
            self->guarded([&] {
                self->write();
                self->read_on();
            });
        });
    }

    websocket::stream<Stream> stream_;
    Shared& shared_;
    ConnectionBook::Place place_;
    ClientId id_;
    scene::Rights rights_;  ///< by the address that it came by
    beast::flat_buffer buffer_;
    std::deque<std::size_t> waiting_;  ///< sizes of the commands that have no reply yet
    std::size_t waiting_bytes_ = 0;    ///< their total
    std::size_t held_bytes_ = 0;       ///< the same and what is being received
    bool read_pauses_ = false;
    std::deque<SharedText> texts_;
    std::size_t unsent_ = 0;  ///< bytes of all queued texts
    SharedText outgoing_;     ///< being written
    bool frame_wanted_ = false;
    std::uint64_t seen_ = 0;
    asio::steady_timer watch_;
    bool was_heard_ = true, is_pinging_ = false;
    int silent_periods_ = 0;
};

// ---------------------------------------------------------------------------------------------------------------------------
// A connection that uses HTTP, until it becomes a WebSocket.

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(tcp::socket&& socket, Shared& shared, ConnectionBook::Place place)
        : stream_(std::move(socket)), shared_(shared), place_(std::move(place)) {}

    /// Reads the first request. A server with TLS answers who comes without it, too, and sends him to the right
    /// address.
    void start() {
        if (!shared_.tls) return read_header();
        connection().expires_after(longest_silence);
        may_be_given_up();
        beast::async_detect_ssl(connection(), buffer_, [self = shared_from_this()](error_code error, bool is_tls) {
            if (error) return self->close();
            if (!is_tls) return self->read_header();
            self->place_.be_busy();
            self->stream_.begin_tls(*self->shared_.tls, self->buffer_.data(),
                                    [self](error_code failed, std::size_t used) {
                                        self->buffer_.consume(used);
                                        if (failed) return self->connection().close();
                                        self->read_header();
                                    });
        });
    }

private:
    beast::tcp_stream& connection() { return stream_.next_layer(); }

    void read_header() {
        header_.emplace();
        // The header first: the limit of the body's size depends on the request.
        header_->body_limit(std::numeric_limits<std::uint64_t>::max());
        connection().expires_after(longest_silence);
        may_be_given_up();
        http::async_read_header(stream_, buffer_, *header_, [self = shared_from_this()](error_code error, std::size_t) {
            if (error) return self->close();
            self->place_.be_busy();
            self->read_body();
        });
    }

    void read_body() {
        const auto& header = header_->get();
        request_ = describe(header);
        is_head_ = header.method() == http::verb::head;
        keep_alive_ = header.keep_alive();
        version_ = header.version();
        if (shared_.tls && !stream_.has_tls()) return refuse(answer_without_tls(request_));
        const bool upgrade = websocket::is_upgrade(header);
        const bool is_page = !upgrade && Routes::is_page(request_);
        const Access access = check_access(shared_.access, request_, is_page);
        if (!access.granted) return refuse(error_response(403, request_.target, access.why));
        token_ = access.token;
        if (upgrade) return become_web_socket(access.rights);
        if (ImportRequests::is_import(request_) && !access.rights.edit)
            return refuse(error_response(403, request_.target,
                                         "this address is for looking, not for changing the library",
                                         "ask for an address for those who build along"));
        if (ImportRequests::is_import(request_)) return begin_upload();
        body_.emplace(std::move(*header_));
        body_->body_limit(largest_other_body);
        connection().expires_after(longest_silence);
        http::async_read(stream_, buffer_, *body_, [self = shared_from_this()](error_code error, std::size_t) {
            if (error == http::error::body_limit)
                return self->refuse(error_response(413, self->request_.target, "has too large a body"));
            if (error) return self->close();
            self->answer();
        });
    }

    void become_web_socket(scene::Rights rights) {
        if (decoded_path(request_.target) != "/ws")
            return refuse(error_response(404, request_.target, "the WebSocket is at /ws"));
        if (!place_.become_viewer())
            return refuse(error_response(503, request_.target, "too many viewers are connected",
                                         "close some of them, and try again"));
        connection().expires_never();
        std::make_shared<WebSocketClient>(std::move(stream_), shared_, std::move(place_), rights)
            ->accept(header_->release());
    }

    // Uploads -----------------------------------------------------------------------------------------------------

    // Receives the upload in pieces and writes them to a file on another thread.
    void begin_upload() {
        const Result<std::string> name = ImportRequests::file_name(request_);
        if (!name) return refuse(error_response(400, name.error().where, name.error().why, name.error().remedy));
        if (header_->content_length().value_or(0) > largest_upload)
            return refuse(error_response(413, request_.target,
                                         "is larger than " + std::to_string(largest_upload) + " bytes",
                                         "import large files with: embody import FILE"));
        upload_ends_ = Clock::now() + longest_upload;
        shared_.upload_queue->post([self = shared_from_this(), name = name.value()] {
            auto begun = self->shared_.uploads->begin(name);
            asio::post(self->shared_.io, [self, begun = std::move(begun)] {
                const Error& error = begun.ok() ? Error{} : begun.error();
                if (!begun.ok()) return self->refuse(error_response(503, error.where, error.why, error.remedy));
                self->upload_ = begun.value();
                self->upload_body_.emplace(std::move(*self->header_));
                self->upload_body_->body_limit(largest_upload);
                self->piece_.resize(piece_bytes);
                self->receive_piece();
            });
        });
    }

    void receive_piece() {
        if (upload_body_->is_done()) return finish_upload();
        auto& body = upload_body_->get().body();
        body.data = piece_.data();
        body.size = piece_.size();
        body.more = true;
        connection().expires_at(std::min(Clock::now() + longest_stall, upload_ends_));
        http::async_read_some(
            stream_, buffer_, *upload_body_, [self = shared_from_this()](error_code error, std::size_t) {
                if (error == http::error::need_buffer) error = {};
                if (error == http::error::body_limit)
                    return self->refuse(error_response(413, self->request_.target, "has too large a body"));
                if (error) return self->close();
                self->write_piece(self->piece_.size() - self->upload_body_->get().body().size);
            });
    }

    void write_piece(std::size_t size) {
        shared_.upload_queue->post([self = shared_from_this(), size] {
            const Result<void> written = self->upload_->write({self->piece_.data(), size});
            asio::post(self->shared_.io, [self, written] {
                if (!written.ok()) return self->refuse_upload(written.error());
                self->receive_piece();
            });
        });
    }

    void finish_upload() {
        // An import takes long: it is answered from its own thread, through the network thread.
        connection().expires_never();
        shared_.upload_queue->post([self = shared_from_this()] {
            const Result<void> finished = self->upload_->finish();
            asio::post(self->shared_.io, [self, finished] {
                if (!finished.ok()) return self->refuse_upload(finished.error());
                self->shared_.imports->start(std::move(self->upload_), self->respond_later());
            });
        });
    }

    void refuse_upload(const Error& error) { refuse(error_response(507, error.where, error.why, error.remedy)); }

    /// The connection may be closed to make room for others, because it only waits.
    void may_be_given_up() {
        place_.be_idle([weak = weak_from_this()] {
            if (const auto self = weak.lock()) self->connection().close();
        });
    }

    // Answers -----------------------------------------------------------------------------------------------------

    void answer() {
        // The client may wait for its answer without a limit: for the current command, say.
        connection().expires_never();
        if (Routes::is_scene(request_)) {
            may_be_given_up();
            shared_.scene->request_document([self = shared_from_this()](scene::Document document) {
                self->compute(
                    [self, document = std::move(document)] { return self->shared_.routes->answer_scene(document); });
            });
            return;
        }
        compute([self = shared_from_this()] { return self->shared_.routes->answer(self->request_); });
    }

    /// From any thread: runs `make` on the queue and posts its answer back.
    void compute(std::function<HttpResponse()> make) {
        shared_.route_queue->post([make = std::move(make), respond = respond_later()] {
            try {
                respond(make());
            } catch (const std::exception& thrown) {
                respond(error_response(500, "the server", std::string("failed: ") + thrown.what()));
            }
        });
    }

    /// A function that other threads call with the answer.
    std::function<void(HttpResponse)> respond_later() {
        return [self = shared_from_this()](HttpResponse response) {
            asio::post(self->shared_.io,
                       [self, response = std::move(response)]() mutable { self->respond(std::move(response)); });
        };
    }

    static HttpRequest describe(const http::request<http::empty_body>& header) {
        const auto text = [&](auto field) { return std::string(header[field]); };
        HttpRequest request;
        request.method = std::string(header.method_string());
        request.target = std::string(header.target());
        request.host = text(http::field::host);
        request.origin = text(http::field::origin);
        request.cookie = text(http::field::cookie);
        request.if_none_match = text(http::field::if_none_match);
        request.fetch_site = text("Sec-Fetch-Site");
        request.fetch_mode = text("Sec-Fetch-Mode");
        request.fetch_dest = text("Sec-Fetch-Dest");
        return request;
    }

    /// On the queue, because removing a large file takes a moment.
    void drop_upload() {
        if (upload_) shared_.upload_queue->post([upload = std::exchange(upload_, nullptr)] {});
    }

    /// Answers without reading what the client still sends.
    void refuse(HttpResponse answer) {
        drop_upload();
        keep_alive_ = false;
        respond(std::move(answer));
    }

    void respond(HttpResponse answer) {
        place_.be_busy();
        response_.emplace(static_cast<http::status>(answer.status), version_);
        response_->set(http::field::server, "embody");
        response_->set(http::field::content_type, answer.content_type);
        for (const auto& [name, value] : protective_headers()) response_->set(name, value);
        for (const auto& [name, value] : answer.headers) response_->set(name, value);
        // The page's first load carries the token in its address; the rest of its requests bring it as a cookie.
        if (!token_.empty() && answer.status < 400 && !query_parameter(request_.target, "token").empty())
            response_->set("Set-Cookie", std::string(token_cookie) + "=" + token_ +
                                             "; HttpOnly; SameSite=Strict; Path=/" + (shared_.tls ? "; Secure" : ""));
        response_->keep_alive(keep_alive_);
        response_->content_length(answer.body.size());
        if (!is_head_) response_->body() = std::move(answer.body);
        connection().expires_after(longest_answer);
        http::async_write(stream_, *response_, [self = shared_from_this()](error_code error, std::size_t) {
            self->response_.reset();
            if (error || !self->keep_alive_) return self->close();
            self->read_header();
        });
    }

    // Reads for a moment what the client still sends: otherwise the system would reset the connection and discard the
    // answer.
    void close() {
        drop_upload();
        error_code ignored;
        // Within TLS, a connection that ends without its farewell looks like an attack: the client ends it.
        if (!stream_.has_tls()) connection().socket().shutdown(tcp::socket::shutdown_send, ignored);
        connection().expires_after(std::chrono::seconds(5));
        may_be_given_up();
        read_rest();
    }

    void read_rest() {
        buffer_.clear();
        stream_.async_read_some(buffer_.prepare(64 << 10), [self = shared_from_this()](error_code error, std::size_t) {
            if (error)
                self->connection().close();
            else
                self->read_rest();
        });
    }

    Stream stream_;
    Shared& shared_;
    ConnectionBook::Place place_;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::empty_body>> header_;
    std::optional<http::request_parser<http::string_body>> body_;
    std::optional<http::request_parser<http::buffer_body>> upload_body_;
    HttpRequest request_;
    std::string token_;  ///< that it came with
    bool is_head_ = false, keep_alive_ = false;
    unsigned version_ = 11;
    std::shared_ptr<Upload> upload_;
    std::vector<char> piece_;  ///< of the upload, between socket and file
    Clock::time_point upload_ends_;
    std::optional<http::response<http::string_body>> response_;
};

}  // namespace

// ---------------------------------------------------------------------------------------------------------------------------

struct Server::State {
    Shared shared;
    std::optional<tcp::acceptor> acceptor;
    std::optional<asio::signal_set> signals;
    asio::steady_timer accept_again{shared.io};
    Clock::time_point accept_failure_told{};
    std::string address;
    std::atomic<bool> frame_posted{false};

    Result<void> listen(const ServerOptions& options);
    Result<void> use_certificate(const ServerOptions& options);
    Result<void> open_routes(const ServerOptions& options);
    [[nodiscard]] std::string url_at(const std::string& at, std::size_t invitation = 0) const;
    [[nodiscard]] std::vector<std::string> addresses_for_others() const;
    [[nodiscard]] nlohmann::json invitations() const;
    void accept();
    void accept_later(const error_code& error);
    void welcome(tcp::socket socket);
    [[nodiscard]] std::vector<std::shared_ptr<WebSocketClient>> clients() const;
    [[nodiscard]] std::shared_ptr<WebSocketClient> client(ClientId id) const;  ///< null: it has left
    SceneThreadListener listener();
    void stop();
    void request_end();
};

Server::Server() : state_(std::make_unique<State>()) {}

Server::~Server() {
    state_->request_end();
    // The scene first: it posts to the io_context until it has ended; then the queues that answer from its document.
    state_->shared.scene.reset();
    // The fill works on the thread of the imports, and asks them whether to end.
    if (state_->shared.imports) (void)state_->shared.imports->wait_ended(Clock::time_point::max());
    state_->shared.fill.reset();
    state_->shared.imports.reset();
    state_->shared.route_queue.reset();
    state_->shared.upload_queue.reset();
    state_->stop();
    // Their sockets belong to the io_context.
    state_->shared.clients.clear();
}

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options) {
    std::unique_ptr<Server> server(new Server);
    State& state = *server->state_;
    if (auto secured = state.use_certificate(options); !secured) return secured.error();
    if (auto opened = state.open_routes(options); !opened) return opened.error();
    if (auto listening = state.listen(options); !listening) return listening.error();
    Shared& shared = state.shared;
    shared.imports = std::make_unique<ImportRequests>(options.scene.database, options.scene.taxonomy_folder);
    const SceneThreadListener listener = state.listener();
    FillOptions fill = options.fill;
    fill.wanted = [&shared] { return shared.scene->missing_models(); };
    shared.fill = std::make_unique<LibraryFill>(std::move(fill), options.scene.database, options.scene.taxonomy_folder,
                                                *shared.imports, listener.broadcast);
    SceneThreadOptions scene_options = options.scene;
    scene_options.greeting = [&state](const scene::Rights& rights) {
        nlohmann::json about = {{"tls", state.shared.tls != nullptr}};
        if (rights.invite) about["invitations"] = state.invitations();
        return nlohmann::json{{"import", state.shared.fill->state()}, {"server", std::move(about)}};
    };
    auto scene = SceneThread::start(scene_options, listener);
    if (!scene) return scene.error();
    shared.scene = std::move(*scene);
    state.accept();
    // Before anybody is told the address: who stops the server then stops it in order.
    state.signals.emplace(shared.io, SIGINT, SIGTERM);
    state.signals->async_wait([&state](error_code error, int) {
        if (!error) state.stop();
    });
    return server;
}

Result<void> Server::State::use_certificate(const ServerOptions& options) {
    if (!options.certificate) return {};
    if (auto right = check_certificate(*options.certificate, std::time(nullptr)); !right) return right;
    shared.tls = std::make_unique<asio::ssl::context>(asio::ssl::context::tls_server);
    error_code error;
    shared.tls->set_options(asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1, error);
    if (!error) shared.tls->use_certificate_chain_file(options.certificate->certificate.string(), error);
    if (!error) shared.tls->use_private_key_file(options.certificate->key.string(), asio::ssl::context::pem, error);
    if (error) return Error{options.certificate->certificate.string(), "cannot be used: " + error.message(), ""};
    return {};
}

Result<void> Server::State::open_routes(const ServerOptions& options) {
    std::vector<std::unique_ptr<catalog::Catalog>> catalogs;
    for (std::size_t i = 0; i < route_threads; ++i) {
        auto catalog = catalog::Catalog::open(options.scene.database, options.scene.taxonomy_folder);
        if (!catalog) return catalog.error();
        catalogs.push_back(std::move(*catalog));
    }
    auto uploads = UploadStore::open(options.scene.database.string() + "-uploads");
    if (!uploads) return uploads.error();
    shared.uploads = std::move(*uploads);
    shared.routes = std::make_unique<Routes>(std::move(catalogs), options.studio_folder,
                                             [this] { return shared.scene->scene_title(); });
    shared.route_queue = std::make_unique<WorkQueue>(route_threads);
    shared.upload_queue = std::make_unique<WorkQueue>(1);
    return {};
}

Result<void> Server::State::listen(const ServerOptions& options) {
    error_code error;
    const asio::ip::address ip = asio::ip::make_address(options.address, error);
    if (error) return Error{"--address " + options.address, "is not an IP address", "for example 127.0.0.1 or 0.0.0.0"};
    shared.access.loopback_only = ip.is_loopback();
    shared.access.tls = options.certificate.has_value();
    if (!ip.is_loopback()) shared.access.invitations = new_invitations();
    address = options.address;
    acceptor.emplace(shared.io);
    acceptor->open(ip.is_v6() ? tcp::v6() : tcp::v4(), error);
    if (!error) acceptor->set_option(asio::socket_base::reuse_address(true), error);
    if (!error) {
        acceptor->bind({ip, options.port}, error);
        if (error == asio::error::address_in_use && options.any_port_if_taken) acceptor->bind({ip, 0}, error);
    }
    if (!error) acceptor->listen(asio::socket_base::max_listen_connections, error);
    if (error)
        return Error{options.address + ":" + std::to_string(options.port), "cannot listen: " + error.message(),
                     "choose another with --port"};
    shared.access.port = acceptor->local_endpoint().port();
    return {};
}

void Server::State::accept() {
    acceptor->async_accept([this](error_code error, tcp::socket socket) {
        if (error == asio::error::operation_aborted) return;
        if (error) return accept_later(error);
        welcome(std::move(socket));
        accept();
    });
}

// Probably no descriptor is left: tries again after a pause, when a connection may have ended.
void Server::State::accept_later(const error_code& error) {
    if (Clock::now() - accept_failure_told > accept_failure_period) {
        accept_failure_told = Clock::now();
        std::fprintf(stderr, "embody: a connection could not be accepted: %s\n", error.message().c_str());
    }
    accept_again.expires_after(accept_pause);
    accept_again.async_wait([this](error_code stopped) {
        if (!stopped) accept();
    });
}

void Server::State::welcome(tcp::socket socket) {
    error_code ignored;
    const auto client = socket.remote_endpoint(ignored).address();
    auto place = shared.connections.admit(client.to_string());
    if (!place) {
        // Sends as much as the socket takes at once, without waiting for a refused client.
        static constexpr std::string_view answer =
            "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nRetry-After: 10\r\nContent-Length: 0\r\n\r\n";
        socket.non_blocking(true, ignored);
        socket.write_some(asio::buffer(answer), ignored);
        return;
    }
    // Small frames must not wait for more to come.
    socket.set_option(tcp::no_delay(true), ignored);
    try {
        std::make_shared<HttpConnection>(std::move(socket), shared, std::move(*place))->start();
    } catch (const std::exception& thrown) {
        report_failure(thrown);
    }
}

// Sending may remove a client from the map, so callers iterate over a copy.
std::vector<std::shared_ptr<WebSocketClient>> Server::State::clients() const {
    std::vector<std::shared_ptr<WebSocketClient>> all;
    for (const auto& [id, client] : shared.clients) all.push_back(client);
    return all;
}

std::shared_ptr<WebSocketClient> Server::State::client(ClientId id) const {
    const auto found = shared.clients.find(id);
    return found == shared.clients.end() ? nullptr : found->second;
}

SceneThreadListener Server::State::listener() {
    SceneThreadListener listener;
    listener.reply = [this](ClientId id, std::string text) {
        asio::post(shared.io, [this, id, text = std::move(text)]() mutable {
            if (const auto to = client(id)) to->send_reply(std::move(text));
        });
    };
    listener.send = [this](ClientId id, std::string text) {
        asio::post(shared.io, [this, id, text = std::make_shared<const std::string>(std::move(text))] {
            if (const auto to = client(id)) to->send_text(text);
        });
    };
    listener.broadcast = [this](std::string text) {
        asio::post(shared.io, [this, text = std::make_shared<const std::string>(std::move(text))] {
            for (const auto& client : clients()) client->send_text(text);
        });
    };
    listener.states_changed = [this] {
        // One posted call is enough: it will find the newest states.
        if (frame_posted.exchange(true)) return;
        asio::post(shared.io, [this] {
            frame_posted = false;
            for (const auto& client : clients()) client->send_frame();
        });
    };
    return listener;
}

void Server::State::stop() {
    error_code ignored;
    if (acceptor) acceptor->close(ignored);
    if (signals) signals->cancel(ignored);
    shared.io.stop();
}

void Server::State::request_end() {
    if (shared.scene) shared.scene->request_stop();
    if (shared.imports) shared.imports->request_stop();
    if (shared.route_queue) shared.route_queue->request_stop();
    if (shared.upload_queue) shared.upload_queue->request_stop();
}

std::string Server::State::url_at(const std::string& at, std::size_t invitation) const {
    const std::string host = at.find(':') == std::string::npos ? at : "[" + at + "]";
    std::string url = (shared.tls ? "https://" : "http://") + host + ":" + std::to_string(shared.access.port) + "/";
    if (!shared.access.invitations.empty()) url += "?token=" + shared.access.invitations[invitation].token;
    return url;
}

std::string Server::url() const {
    const bool is_any = state_->address == "0.0.0.0" || state_->address == "::";
    return state_->url_at(is_any ? "127.0.0.1" : state_->address);
}

// This machine's addresses in its networks; none where it listens on loopback only.
std::vector<std::string> Server::State::addresses_for_others() const {
    if (shared.access.loopback_only) return {};
    if (address == "0.0.0.0" || address == "::") return lan_addresses(address == "::");
    return {address};
}

// For who may invite others: [{rights, urls}…].
nlohmann::json Server::State::invitations() const {
    nlohmann::json all = nlohmann::json::array();
    const std::vector<std::string> addresses = addresses_for_others();
    if (addresses.empty()) return all;
    for (std::size_t i = 0; i < shared.access.invitations.size(); ++i) {
        nlohmann::json urls = nlohmann::json::array();
        for (const std::string& at : addresses) urls.push_back(url_at(at, i));
        all.push_back({{"rights", scene::rights_to_json(shared.access.invitations[i].rights)}, {"urls", urls}});
    }
    return all;
}

std::vector<Server::Addresses> Server::urls_for_others() const {
    std::vector<Addresses> all;
    for (const std::string& at : state_->addresses_for_others())
        all.push_back({state_->url_at(at, 0), state_->url_at(at, 1), state_->url_at(at, 2)});
    return all;
}

void Server::run() {
    state_->shared.fill->start();
    // An exception of a handler (memory, files) ends its own connection and nothing else.
    for (;;) {
        try {
            state_->shared.io.run();
            return;
        } catch (const std::exception& thrown) {
            report_failure(thrown);
        }
    }
}

bool Server::end_within(std::chrono::milliseconds time) {
    Shared& shared = state_->shared;
    state_->request_end();
    const Clock::time_point until = Clock::now() + time;
    if (shared.scene->wait_ended(until) && shared.imports->wait_ended(until) && shared.route_queue->wait_ended(until) &&
        shared.upload_queue->wait_ended(until))
        return true;
    shared.uploads->remove_all();
    return false;
}

void Server::request_stop() {
    asio::post(state_->shared.io, [this] { state_->stop(); });
}

}  // namespace embody::server
