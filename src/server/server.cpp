// SPDX-License-Identifier: MIT
//
// The transport: the only file that sees Boost.Beast, which takes most of this layer's compile time. One network thread
// runs the io_context; the scene has its own thread (scene_thread.h), and so has each import.
#include "server/server.h"

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdio>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <thread>

#include "foundation/printable.h"
#include "server/access.h"
#include "server/import_request.h"
#include "server/routes.h"

namespace embody::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using beast::error_code;

constexpr std::uint64_t largest_upload = std::uint64_t{256} << 20;
constexpr std::uint64_t largest_other_body = 64 << 10;
constexpr std::size_t largest_command = std::size_t{64} << 20;   ///< a whole scene may come as one
constexpr std::size_t most_unsent_text = std::size_t{64} << 20;  ///< a client that reads nothing is let go
/// Of one client: commands that wait for their reply, and replies that it has not read. Its next commands stay in the
/// socket until there is less, so that a flood fills no memory.
constexpr std::size_t most_waiting_commands = 256;
constexpr std::size_t most_waiting_bytes = largest_command;
constexpr std::size_t most_unread_replies = std::size_t{1} << 20;

class WebSocketClient;

/// What connections share; lives as long as the server, which outlives them.
struct Shared {
    asio::io_context io;
    AccessRules access;
    std::unique_ptr<Routes> routes;
    std::unique_ptr<ImportRequests> imports;
    std::unique_ptr<SceneThread> scene;
    std::map<ClientId, std::weak_ptr<WebSocketClient>> clients;
    ClientId next_client = 1;
};

std::string random_token() {
    std::random_device device;
    std::string token;
    for (int i = 0; i < 32; ++i) token.push_back("0123456789abcdef"[device() % 16]);
    return token;
}

// ---------------------------------------------------------------------------------------------------------------------------
// A browser or script on the WebSocket.

class WebSocketClient : public std::enable_shared_from_this<WebSocketClient> {
public:
    WebSocketClient(tcp::socket&& socket, Shared& shared)
        : stream_(std::move(socket)), shared_(shared), id_(shared.next_client++) {}

    void accept(const http::request<http::string_body>& request) {
        websocket::stream_base::timeout timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
        stream_.set_option(timeout);
        stream_.read_message_max(largest_command);
        stream_.auto_fragment(false);
        stream_.async_accept(request, [self = shared_from_this()](error_code error) {
            if (error) return;
            self->shared_.clients[self->id_] = self;
            self->read();
            self->send_frame();
        });
    }

    void send_text(std::string text) {
        unsent_ += text.size();
        if (unsent_ > most_unsent_text) {
            close();
            return;
        }
        texts_.push_back(std::move(text));
        write();
    }

    /// Newest states, as soon as nothing else is being written.
    void send_frame() {
        frame_wanted_ = true;
        write();
    }

    void send_reply(std::string text) {
        if (--waiting_commands_ == 0) waiting_bytes_ = 0;
        send_text(std::move(text));
        read_on();
    }

    void close() {
        error_code ignored;
        beast::get_lowest_layer(stream_).socket().close(ignored);
        leave();
    }

private:
    void leave() {
        if (shared_.clients.erase(id_) > 0) shared_.scene->forget(id_);
    }
    [[nodiscard]] bool has_enough_waiting() const {
        return waiting_commands_ >= most_waiting_commands || waiting_bytes_ >= most_waiting_bytes ||
               unsent_ >= most_unread_replies;
    }
    void read_on() {
        if (read_pauses_ && !has_enough_waiting()) read();
    }

    void read() {
        read_pauses_ = false;
        stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t size) {
            if (error) {
                self->leave();
                return;
            }
            self->shared_.scene->post(self->id_, beast::buffers_to_string(self->buffer_.data()));
            self->buffer_.consume(self->buffer_.size());
            ++self->waiting_commands_;
            self->waiting_bytes_ += size;
            self->read_pauses_ = self->has_enough_waiting();
            if (!self->read_pauses_) self->read();
        });
    }

    // One write at a time: texts in order, frames only when no text waits and always the newest states.
    void write() {
        if (writing_) return;
        if (!texts_.empty()) {
            outgoing_ = std::move(texts_.front());
            texts_.pop_front();
            unsent_ -= outgoing_.size();
            stream_.text(true);
        } else if (frame_wanted_) {
            frame_wanted_ = false;
            SceneThread::Frame frame = shared_.scene->frame_since(seen_);
            seen_ = frame.version;
            if (frame.bytes.empty()) return;
            outgoing_ = std::move(frame.bytes);
            stream_.binary(true);
        } else {
            return;
        }
        writing_ = true;
        stream_.async_write(asio::buffer(outgoing_), [self = shared_from_this()](error_code error, std::size_t) {
            self->writing_ = false;
            if (error) {
                self->leave();
                return;
            }
            self->write();
            self->read_on();
        });
    }

    websocket::stream<beast::tcp_stream> stream_;
    Shared& shared_;
    ClientId id_;
    beast::flat_buffer buffer_;
    std::deque<std::string> texts_;
    std::size_t unsent_ = 0;
    std::size_t waiting_commands_ = 0, waiting_bytes_ = 0;
    bool read_pauses_ = false;
    std::string outgoing_;
    bool writing_ = false;
    bool frame_wanted_ = false;
    std::uint64_t seen_ = 0;
};

// ---------------------------------------------------------------------------------------------------------------------------
// A connection that speaks HTTP, until it becomes a WebSocket.

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(tcp::socket&& socket, Shared& shared) : stream_(std::move(socket)), shared_(shared) {}

    void read_header() {
        parser_.emplace();
        // The whole header first: how large a body may be depends on what is asked.
        parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
        stream_.expires_after(std::chrono::seconds(60));
        http::async_read_header(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
            if (error) return self->close();
            self->read_body();
        });
    }

private:
    void read_body() {
        const auto& header = parser_->get();
        const HttpRequest request = describe(header);
        const bool upgrade = websocket::is_upgrade(header);
        const Access access = check_access(shared_.access, request, upgrade || request.method != "GET");
        if (!access.granted) return respond(error_response(403, request.target, access.why), false);
        if (upgrade) {
            if (decoded_path(request.target) != "/ws")
                return respond(error_response(404, request.target, "the WebSocket is at /ws"), false);
            stream_.expires_never();
            std::make_shared<WebSocketClient>(stream_.release_socket(), shared_)->accept(parser_->release());
            return;
        }
        const std::uint64_t limit = ImportRequests::is_import(request) ? largest_upload : largest_other_body;
        if (parser_->content_length().value_or(0) > limit)
            return respond(error_response(413, request.target, "is larger than " + std::to_string(limit) + " bytes",
                                          "import large files with: embody import FILE"),
                           false);
        parser_->body_limit(limit);
        stream_.expires_after(std::chrono::minutes(10));
        http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
            if (error == http::error::body_limit)
                return self->respond(error_response(413, "body", "is too large"), false);
            if (error) return self->close();
            self->answer();
        });
    }

    void answer() {
        HttpRequest request = describe(parser_->get());
        request.body = std::move(parser_->get().body());
        const bool keep_alive = parser_->get().keep_alive();
        if (ImportRequests::is_import(request)) {
            // Takes long: answered from its own thread, back through the network thread.
            stream_.expires_never();
            shared_.imports->start(std::move(request), [self = shared_from_this(), keep_alive](HttpResponse response) {
                asio::post(self->shared_.io, [self, keep_alive, response = std::move(response)]() mutable {
                    self->respond(std::move(response), keep_alive);
                });
            });
            return;
        }
        HttpResponse response = shared_.routes->answer(request);
        // The page's first load carries the token in its address; the rest of its requests bring it as a cookie.
        if (!shared_.access.token.empty() && !query_parameter(request.target, "token").empty())
            response.headers["Set-Cookie"] =
                std::string(token_cookie) + "=" + shared_.access.token + "; HttpOnly; SameSite=Strict; Path=/";
        respond(std::move(response), keep_alive);
    }

    static HttpRequest describe(const http::request<http::string_body>& header) {
        const auto text = [&](http::field field) { return std::string(header[field]); };
        HttpRequest request;
        request.method = std::string(header.method_string());
        request.target = std::string(header.target());
        request.host = text(http::field::host);
        request.origin = text(http::field::origin);
        request.cookie = text(http::field::cookie);
        request.if_none_match = text(http::field::if_none_match);
        return request;
    }

    void respond(HttpResponse answer, bool keep_alive) {
        const bool head = parser_->get().method() == http::verb::head;
        response_.emplace(static_cast<http::status>(answer.status), parser_->get().version());
        response_->set(http::field::server, "embody");
        response_->set(http::field::content_type, answer.content_type);
        response_->set("X-Content-Type-Options", "nosniff");
        response_->set("Referrer-Policy", "no-referrer");
        for (const auto& [name, value] : answer.headers) response_->set(name, value);
        response_->keep_alive(keep_alive);
        response_->content_length(answer.body.size());
        if (!head) response_->body() = std::move(answer.body);
        stream_.expires_after(std::chrono::minutes(2));
        http::async_write(stream_, *response_, [self = shared_from_this(), keep_alive](error_code error, std::size_t) {
            if (error || !keep_alive) return self->close();
            self->read_header();
        });
    }

    // What the client still sends is read for a moment: else the system would take back the answer that refuses it.
    void close() {
        error_code ignored;
        stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        stream_.expires_after(std::chrono::seconds(5));
        read_rest();
    }

    void read_rest() {
        buffer_.clear();
        stream_.async_read_some(buffer_.prepare(64 << 10), [self = shared_from_this()](error_code error, std::size_t) {
            if (error)
                self->stream_.close();
            else
                self->read_rest();
        });
    }

    beast::tcp_stream stream_;
    Shared& shared_;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::string_body>> parser_;
    std::optional<http::response<http::string_body>> response_;
};

}  // namespace

// ---------------------------------------------------------------------------------------------------------------------------

struct Server::State {
    Shared shared;
    std::optional<tcp::acceptor> acceptor;
    std::optional<asio::signal_set> signals;
    asio::steady_timer accept_again{shared.io};
    std::string address;
    std::atomic<bool> frame_posted{false};

    Result<void> listen(const ServerOptions& options);
    void accept();
    SceneThreadListener listener();
    void stop();
};

Server::Server() : state_(std::make_unique<State>()) {}

Server::~Server() {
    // The scene first: it posts to the io_context until it has ended.
    state_->shared.scene.reset();
    state_->shared.imports.reset();
    state_->stop();
}

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options) {
    std::unique_ptr<Server> server(new Server);
    State& state = *server->state_;
    auto catalog = catalog::Catalog::open(options.scene.database, options.scene.taxonomy_folder);
    if (!catalog) return catalog.error();
    if (auto listening = state.listen(options); !listening) return listening.error();
    auto scene = SceneThread::start(options.scene, state.listener());
    if (!scene) return scene.error();
    state.shared.scene = std::move(*scene);
    state.shared.routes = std::make_unique<Routes>(
        std::move(*catalog), options.studio_folder, [&shared = state.shared] { return shared.scene->scene_json(); },
        [&shared = state.shared] { return shared.scene->scene_title(); });
    state.shared.imports = std::make_unique<ImportRequests>(options.scene.database, options.scene.taxonomy_folder);
    state.accept();
    return server;
}

Result<void> Server::State::listen(const ServerOptions& options) {
    error_code error;
    const asio::ip::address ip = asio::ip::make_address(options.address, error);
    if (error) return Error{"--address " + options.address, "is not an IP address", "for example 127.0.0.1 or 0.0.0.0"};
    shared.access.loopback_only = ip.is_loopback();
    if (!ip.is_loopback()) shared.access.token = random_token();
    address = ip.is_v6() ? "[" + options.address + "]" : options.address;
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
        if (error) {
            // No descriptor is left, most likely: the next try is for when a connection has ended.
            accept_again.expires_after(std::chrono::milliseconds(100));
            accept_again.async_wait([this](error_code stopped) {
                if (!stopped) accept();
            });
            return;
        }
        // Small frames must not wait for more to come.
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<HttpConnection>(std::move(socket), shared)->read_header();
        accept();
    });
}

SceneThreadListener Server::State::listener() {
    const auto client = [this](ClientId id) {
        const auto found = shared.clients.find(id);
        return found == shared.clients.end() ? nullptr : found->second.lock();
    };
    SceneThreadListener listener;
    listener.reply = [this, client](ClientId id, std::string text) {
        asio::post(shared.io, [client, id, text = std::move(text)]() mutable {
            if (const auto to = client(id)) to->send_reply(std::move(text));
        });
    };
    listener.broadcast = [this](std::string text) {
        asio::post(shared.io, [this, text = std::move(text)] {
            // send_text may drop a client, so not while walking the map.
            std::vector<std::shared_ptr<WebSocketClient>> all;
            for (const auto& [id, weak] : shared.clients)
                if (auto to = weak.lock()) all.push_back(std::move(to));
            for (const auto& to : all) to->send_text(text);
        });
    };
    listener.states_changed = [this] {
        // One wake-up on its way is enough: it will find the newest states.
        if (frame_posted.exchange(true)) return;
        asio::post(shared.io, [this] {
            frame_posted = false;
            std::vector<std::shared_ptr<WebSocketClient>> all;
            for (const auto& [id, weak] : shared.clients)
                if (auto to = weak.lock()) all.push_back(std::move(to));
            for (const auto& to : all) to->send_frame();
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

std::string Server::url() const {
    const bool any = state_->address == "0.0.0.0" || state_->address == "[::]";
    std::string url = "http://" + (any ? std::string("127.0.0.1") : state_->address) + ":" +
                      std::to_string(state_->shared.access.port) + "/";
    if (!state_->shared.access.token.empty()) url += "?token=" + state_->shared.access.token;
    return url;
}

void Server::run() {
    state_->signals.emplace(state_->shared.io, SIGINT, SIGTERM);
    state_->signals->async_wait([this](error_code error, int) {
        if (!error) state_->stop();
    });
    // What a handler throws (memory, files) ends its own connection and nothing else.
    for (;;) {
        try {
            state_->shared.io.run();
            return;
        } catch (const std::exception& thrown) {
            std::fprintf(stderr, "embody: a connection failed: %s\n", printable(thrown.what()).c_str());
        }
    }
}

void Server::request_stop() {
    asio::post(state_->shared.io, [this] { state_->stop(); });
}

}  // namespace embody::server
