// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/ports.h"
#include "tools/verb.h"

namespace tools {

Action declare_ports(CLI::App& /*app*/, const Common& /*common*/) {
    return [](const decomp::Run&) -> decomp::Result<Answer> {
        const auto ports = cam::transport::list_ports();
        if (!ports) {
            return decomp::fail(ports.error());
        }
        Answer answer;
        answer.json["ports"] = Json::array();
        for (const cam::transport::Port& port : *ports) {
            answer.json["ports"].push_back({{"name", port.name},
                                            {"by_id", port.by_id},
                                            {"description", port.description},
                                            {"usb", port.usb},
                                            {"usb_serial", port.usb_serial},
                                            {"manufacturer", port.manufacturer},
                                            {"product", port.product},
                                            {"accessible", port.accessible}});
            answer.text +=
                port.name + (port.accessible ? "" : " (no permission)") + "  " + port.description;
            answer.text += port.usb.empty() ? "" : "  USB " + port.usb + " " + port.usb_serial;
            answer.text += "\n";
            answer.text += port.by_id.empty() ? "" : "  " + port.by_id + "\n";
        }
        if (ports->empty()) {
            answer.text = "no serial ports; 'hew sim marlin' makes a virtual printer\n";
        }
        return answer;
    };
}

}  // namespace tools
