// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/stream_target.h"

#include "cam/job/lone_part.h"
#include "cam/millproof/record.h"
#include "cam/profile/read_mill.h"
#include "cam/transport/ports.h"
#include "decomp/base/file.h"

#include <algorithm>

namespace tools {

namespace {

namespace fs = std::filesystem;
using cam::stream::Flavour;
using cam::stream::Limits;
using cam::stream::Request;
using decomp::fail;
using decomp::Result;

bool is_mill(const std::string& name) {
    const std::vector<std::string> mills = cam::profile::list_mills();
    return std::find(mills.begin(), mills.end(), name) != mills.end() ||
           name.find("mill/") != std::string::npos;
}

Limits limits_of(const cam::profile::FdmSetup& setup) {
    Limits limits;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        limits.low_mm.at(axis) = setup.machine.chamber.min_mm[static_cast<int>(axis)];
        limits.high_mm.at(axis) = setup.machine.chamber.max_mm[static_cast<int>(axis)];
    }
    limits.max_nozzle_celsius = setup.machine.heaters.max_nozzle_celsius;
    limits.max_bed_celsius = setup.machine.heaters.max_bed_celsius;
    return limits;
}

Limits limits_of(const cam::profile::MillSetup& setup, const cam::profile::Link& link) {
    Limits limits;
    limits.flavour = Flavour::Mill;
    limits.axes = setup.machine.has_rotary() ? 4 : 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        limits.low_mm.at(axis) = setup.machine.travel.min_mm[static_cast<int>(axis)];
        limits.high_mm.at(axis) = setup.machine.travel.max_mm[static_cast<int>(axis)];
    }
    limits.max_feed_mm_per_min = link.mill.max_feed_mm_per_min;
    limits.max_spindle_rpm = link.mill.max_spindle_rpm;
    return limits;
}

Result<std::string> chosen_port(const std::string& wish, const cam::profile::Link& link) {
    if (wish != "auto") {
        return wish;
    }
    if (link.line.protocol == "modbus") {
        if (link.modbus.port.empty()) {
            return fail("transport.not_found", "the link names no port of the machine", link.name,
                        "--port tcp:HOST:PORT or a serial device; or modbus.port in the link");
        }
        return link.modbus.port;
    }
    const auto ports = cam::transport::list_ports();
    if (!ports) {
        return fail(ports.error());
    }
    std::vector<std::string> fitting;
    for (const cam::transport::Port& port : *ports) {
        const std::vector<std::string>& usb = link.identity.usb;
        if (usb.empty() ? !port.usb.empty()
                        : std::find(usb.begin(), usb.end(), port.usb) != usb.end()) {
            fitting.push_back(port.name);
        }
    }
    if (fitting.size() == 1) {
        return fitting.front();
    }
    decomp::Error error{"transport.not_found",
                        fitting.empty() ? "no port is that of this machine"
                                        : "several ports may be that of this machine",
                        {},
                        "name one with --port; 'hew ports' lists them",
                        fitting};
    return fail(error);
}

/// The tools of a milling program as its proof names them; without one those of its machine.
std::vector<std::string> tools_of(const fs::path& program) {
    const auto text = decomp::read_file(program.string() + ".proof.json");
    const auto record = text ? cam::millproof::read_proof_json(*text) : fail(text.error());
    return record ? record->tools : std::vector<std::string>{};
}

/// The program of a job directory, its machine and profile.
Result<Request> from_job(const StreamTarget& target) {
    const auto job = cam::job::read_finished_job(target.job);
    if (!job) {
        return fail(job.error());
    }
    const auto setup = cam::job::setup_of(*job, target.job);
    if (!setup) {
        return fail(setup.error());
    }
    if (job->plates.empty()) {
        return fail("job.no_programs", "the job has no programs yet", target.job.string(),
                    "run 'hew make' with the same options");
    }
    std::string names;
    for (const cam::job::PlateFacts& plate : job->plates) {
        names += (names.empty() ? "" : ", ") + plate.name;
        if (plate.name == target.plate || (target.plate.empty() && job->plates.size() == 1)) {
            Request request;
            request.program = target.job / cam::job::program_path(plate);
            request.machine = job->options.machine;
            request.profile_sha256 = setup->hash;
            request.limits = limits_of(*setup);
            return request;
        }
    }
    return fail("usage.stream", "the job has several plates: " + names, target.job.string(),
                "choose one: --plate plate-1");
}

Result<Request> from_program(const StreamTarget& target, const cam::profile::Link& link) {
    Request request;
    request.program = target.job;
    request.machine = target.machine;
    if (is_mill(target.machine)) {
        const auto setup =
            cam::profile::read_mill_setup(target.machine, tools_of(target.job), target.settings);
        if (!setup) {
            return fail(setup.error());
        }
        request.profile_sha256 = setup->hash;
        request.limits = limits_of(*setup, link);
        return request;
    }
    const auto setup =
        cam::profile::read_fdm_setup(target.machine, target.material, target.settings);
    if (!setup) {
        return fail(setup.error());
    }
    request.profile_sha256 = setup->hash;
    request.limits = limits_of(*setup);
    return request;
}

}  // namespace

Result<Request> stream_request(const StreamTarget& target) {
    StreamTarget own = target;
    std::vector<std::string> of_link;
    for (const std::string& setting : target.settings) {
        if (setting.starts_with("link.") || setting.starts_with("identity.") ||
            setting.starts_with("modbus.")) {
            of_link.push_back(setting);
            std::erase(own.settings, setting);
        }
    }
    Result<Request> request = Request{};
    if (fs::is_directory(own.job)) {
        request = from_job(own);
        if (!request) {
            return request;
        }
        if (!own.machine.empty() && own.machine != request->machine) {
            return fail("usage.stream", "the job was made for " + request->machine,
                        own.job.string(), "leave --machine out");
        }
        own.machine = request->machine;
    } else if (own.machine.empty()) {
        return fail("usage.stream", "a lone program needs --machine", own.job.string(),
                    "'hew machines' lists the names");
    }
    const auto link = cam::profile::read_link(own.link.empty() ? own.machine : own.link, of_link);
    if (!link) {
        return fail(link.error());
    }
    if (!fs::is_directory(own.job)) {
        request = from_program(own, *link);
        if (!request) {
            return request;
        }
    }
    const bool mill = request->limits.flavour == Flavour::Mill;
    if (link->line.protocol != "card" && mill == (link->line.protocol == "marlin")) {
        return fail("usage.stream", "link '" + link->name + "' speaks " + link->line.protocol +
                                        ", which is not for " + own.machine);
    }
    request->link = *link;
    if (link->line.protocol != "card") {
        const auto port = chosen_port(own.port, *link);
        if (!port) {
            return fail(port.error());
        }
        request->port = *port;
    }
    return request;
}

}  // namespace tools
