// SPDX-License-Identifier: MIT
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>

#include "cli/commands.h"
#include "cli/fill_line.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "cli/qr_code.h"
#include "server/certificate.h"
#include "server/lan_addresses.h"
#include "server/server.h"

namespace embody::cli {
namespace {

/// Time for what is still running when the server is told to end; the process has ended within twice that time.
constexpr auto longest_end = std::chrono::milliseconds(1200);

/// Asks the desktop to open the address; no desktop is no error.
void open_in_browser(const std::string& url) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
    std::string program = "xdg-open";
    std::string address = url;
    std::array<char*, 3> words{program.data(), address.data(), nullptr};
    pid_t process = 0;
    if (posix_spawnp(&process, words[0], nullptr, nullptr, words.data(), environ) != 0)
        print_error("No program to open a browser was found; open the address above by hand.\n");
}

/// The files named by the user, or those that Embody makes for the names and addresses of this machine; none without
/// TLS.
Result<std::optional<server::CertificateFiles>> certificate_of(const ServeArguments& arguments) {
    using Files = std::optional<server::CertificateFiles>;
    if (!arguments.certificate.empty()) return Files({arguments.certificate, arguments.key});
    if (!arguments.tls) return Files();
    std::vector<std::string> names = {"localhost", "127.0.0.1", "::1"};
    for (const std::string& address : server::lan_addresses(true)) names.push_back(address);
    if (const std::string name = server::host_name(); !name.empty() && name != "localhost") {
        names.push_back(name);
        if (name.find('.') == std::string::npos) names.push_back(name + ".local");
    }
    const auto folder = catalog::Catalog::default_file().parent_path() / "tls";
    auto files = server::own_certificate(folder, names, std::time(nullptr));
    return files ? Result<Files>(Files(*files)) : Result<Files>(files.error());
}

/// Where the Studio is: here, and for other machines and headsets.
void print_addresses(const server::Server& server, const ServeArguments& arguments,
                     const server::ServerOptions& options) {
    print_text("Studio: {}\n", server.url());
    const std::vector<server::Server::Addresses> others = server.urls_for_others();
    if (!others.empty()) print_text("On other machines and headsets of this network:\n");
    for (const auto& [build, run, look] : others)
        print_text("    {}\n    {} (look and play)\n    {} (look)\n", build, run, look);
    const bool is_terminal = isatty(STDOUT_FILENO) != 0;
    if (arguments.qr || (is_terminal && !others.empty())) {
        const QrColors colors = is_terminal ? QrColors::dark_on_light : QrColors::of_the_terminal;
        write_text(stdout, qr_code(others.empty() ? server.url() : others.front().build, colors));
    }
    if (options.certificate && arguments.certificate.empty()) {
        const auto print = server::fingerprint(options.certificate->certificate);
        print_text("The certificate is Embody's own, so that a browser warns once. Its SHA-256 fingerprint:\n    {}\n",
                   print ? *print : print.error().message());
    }
    if (!options.certificate && !others.empty()) print_text("Headsets offer VR only by https: add --tls.\n");
    print_text("Stop with Ctrl+C.\n");
    std::fflush(stdout);
}

}  // namespace

int run_serve(const ServeArguments& arguments) {
    server::ServerOptions options;
    options.address = arguments.address;
    options.any_port_if_taken = !arguments.port.has_value();
    if (arguments.port) options.port = *arguments.port;
    options.studio_folder = studio_folder();
    options.scene.database = arguments.database;
    options.scene.taxonomy_folder = data_folder() / "taxonomy";
    options.scene.session.saved_scenes = saved_scenes_folder();
    options.scene.session.demo_scenes = data_folder() / "scenes";
    FillLine fill_line;
    auto certificate = certificate_of(arguments);
    if (!certificate) return report(certificate.error());
    options.certificate = std::move(*certificate);
    options.fill.catalogues = arguments.fill;
    options.fill.list = arguments.fill_list;
    options.fill.mark = arguments.fill_mark;
    options.fill.tell = [&fill_line](const server::FillProgress& progress) { fill_line.show(progress); };
    options.scene.open_scene = arguments.scene.value_or("furnished_room");
    // The server opens it again; this call shows the progress where the taxonomy has changed.
    if (auto catalog = open_catalog(arguments.database); !catalog) return report(catalog.error());
    auto server = server::Server::start(options);
    if (!server && !arguments.scene) {
        // An empty scene is better than no Studio.
        const Error no_scene = server.error();
        options.scene.open_scene.clear();
        server = server::Server::start(options);
        if (server) print_error("embody: starting with an empty scene: {}\n", no_scene.message());
    }
    if (!server) return report(server.error());
    print_addresses(**server, arguments, options);
    if (arguments.open_browser) open_in_browser((*server)->url());
    (*server)->run();
    if ((*server)->end_within(longest_end)) return exit_ok;
    // What is still running is left to the system: edits are in the journal, and the database is consistent at any
    // moment.
    std::fflush(nullptr);
    std::_Exit(exit_ok);
}

}  // namespace embody::cli
