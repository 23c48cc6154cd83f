// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_profile.h"
#include "tools/verb.h"

#include <memory>

namespace tools {

namespace {

decomp::Result<Answer> list() {
    Answer answer;
    answer.json["machines"] = Json::array();
    for (const std::string& name : cam::profile::list_machines()) {
        const auto setup = cam::profile::read_fdm_setup(name);
        if (!setup) {
            return decomp::fail(setup.error());
        }
        answer.json["machines"].push_back({{"name", name}, {"title", setup->machine.title}});
        answer.text += name + std::string(name.size() < 28 ? 28 - name.size() : 1, ' ') +
                       setup->machine.title + "\n";
    }
    return answer;
}

decomp::Result<Answer> show(const std::string& name, const std::string& material,
                            const std::vector<std::string>& settings) {
    const auto setup = cam::profile::read_fdm_setup(name, material, settings);
    if (!setup) {
        return decomp::fail(setup.error());
    }
    Answer answer;
    answer.json["machine"] = setup->machine.name;
    answer.json["sha256"] = setup->hash;
    answer.json["fields"] = Json::array();
    for (const cam::profile::FieldRow& row : cam::profile::describe(*setup)) {
        answer.json["fields"].push_back({{"section", row.section},
                                         {"key", row.key},
                                         {"value", row.value},
                                         {"unit", row.unit},
                                         {"range", row.range},
                                         {"doc", row.doc}});
    }
    answer.text = cam::profile::explain(*setup);
    return answer;
}

}  // namespace

Action declare_machines(CLI::App& app, const Common& /*common*/) {
    struct Command {
        std::string what;
        std::string name;
        std::string material;
        std::vector<std::string> settings;
    };

    auto command = std::make_shared<Command>();
    app.add_option("what", command->what, "'show' explains one machine")
        ->check(CLI::IsMember({"show", "list"}));
    app.add_option("name", command->name, "profile to show");
    app.add_option("--material", command->material, "with this filament")->group("Machine");
    app.add_option("--set", command->settings, "with a value changed: KEY=VALUE")
        ->allow_extra_args(false)
        ->group("Machine");
    return [command](const decomp::Run&) -> decomp::Result<Answer> {
        if (command->what != "show") {
            return list();
        }
        if (command->name.empty()) {
            return decomp::fail("usage.machine", "'machines show' needs a name", {},
                                "see 'hew machines' for the names");
        }
        return show(command->name, command->material, command->settings);
    };
}

}  // namespace tools
