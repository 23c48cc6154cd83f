// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/ports.h"

#include <libserialport.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>

namespace cam::transport {

namespace fs = std::filesystem;

namespace {

std::string text_or_empty(const char* text) { return text == nullptr ? "" : text; }

/// Real device by its stable name.
std::map<std::string, std::string> names_by_id() {
    std::map<std::string, std::string> out;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator("/dev/serial/by-id", ignored)) {
        const fs::path real = fs::canonical(entry.path(), ignored);
        if (!ignored) {
            out.emplace(real.string(), entry.path().string());
        }
    }
    return out;
}

Port described(sp_port* port, const std::map<std::string, std::string>& by_id) {
    Port out;
    out.name = text_or_empty(::sp_get_port_name(port));
    out.description = text_or_empty(::sp_get_port_description(port));
    int vendor = 0;
    int product = 0;
    if (::sp_get_port_usb_vid_pid(port, &vendor, &product) == SP_OK) {
        std::array<char, 16> text{};
        std::snprintf(text.data(), text.size(), "%04x:%04x", static_cast<unsigned>(vendor),
                      static_cast<unsigned>(product));
        out.usb = text.data();
        out.usb_serial = text_or_empty(::sp_get_port_usb_serial(port));
        out.manufacturer = text_or_empty(::sp_get_port_usb_manufacturer(port));
        out.product = text_or_empty(::sp_get_port_usb_product(port));
    }
    if (const auto found = by_id.find(out.name); found != by_id.end()) {
        out.by_id = found->second;
    }
    out.accessible = ::access(out.name.c_str(), R_OK | W_OK) == 0;
    return out;
}

}  // namespace

decomp::Result<std::vector<Port>> list_ports() {
    sp_port** found = nullptr;
    if (::sp_list_ports(&found) != SP_OK) {
        return decomp::fail("transport.refused", "the system does not list its serial ports");
    }
    const std::map<std::string, std::string> by_id = names_by_id();
    std::vector<Port> ports;
    for (sp_port** port = found; *port != nullptr; ++port) {
        ports.push_back(described(*port, by_id));
    }
    ::sp_free_port_list(found);
    std::sort(ports.begin(), ports.end(),
              [](const Port& a, const Port& b) { return a.name < b.name; });
    return ports;
}

}  // namespace cam::transport
