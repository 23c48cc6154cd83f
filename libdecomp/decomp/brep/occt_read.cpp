// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/nearest.h"
#include "decomp/brep/occt_detail.h"

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Quantity_Color.hxx>
#include <Resource_Manager.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <ShapeProcess_ShapeContext.hxx>
#include <Standard_Failure.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <map>
#include <mutex>
#include <sstream>

namespace decomp::brep {

namespace {

/// A solid of the file, not yet cut into triangles.
struct Found {
    std::string name;
    std::optional<std::array<double, 3>> colour;
    TopoDS_Shape solid;
};

struct Contents {
    std::vector<Found> solids;
    std::size_t faces_outside = 0;  ///< of sheets
    std::size_t edges_outside = 0;  ///< of wires
};

std::string name_of(const TDF_Label& label) {
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) {
        return {};
    }
    std::string text(static_cast<std::size_t>(name->Get().LengthOfCString()), '\0');
    Standard_PCharacter to = text.data();
    name->Get().ToUTF8CString(to);
    return text;
}

/// Solids in the order of the file; a closed shell alone counts as one.
void add_shape(const TopoDS_Shape& shape, const std::string& name,
               const std::optional<std::array<double, 3>>& colour, Contents& contents) {
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
        contents.solids.push_back({name, colour, it.Current()});
    }
    for (TopExp_Explorer it(shape, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next()) {
        if (BRep_Tool::IsClosed(it.Current())) {
            TopoDS_Solid solid;
            BRep_Builder().MakeSolid(solid);
            BRep_Builder().Add(solid, it.Current());
            contents.solids.push_back({name, colour, solid});
        } else {
            for (TopExp_Explorer face(it.Current(), TopAbs_FACE); face.More(); face.Next()) {
                ++contents.faces_outside;
            }
        }
    }
    for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
        ++contents.faces_outside;
    }
    for (TopExp_Explorer it(shape, TopAbs_EDGE, TopAbs_FACE); it.More(); it.Next()) {
        ++contents.edges_outside;
    }
}

/// Walks the products of a document down to their shapes.
class DocumentWalk {
  public:
    DocumentWalk(const Handle(TDocStd_Document) & document, Contents& contents)
        : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
          colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
          contents_(contents) {}

    void walk() {
        TDF_LabelSequence roots;
        shapes_->GetFreeShapes(roots);
        for (int i = 1; i <= roots.Length(); ++i) {
            visit(roots.Value(i), TopLoc_Location(), {}, std::nullopt);
        }
    }

  private:
    using Colour = std::optional<std::array<double, 3>>;

    [[nodiscard]] Colour colour_of(const TDF_Label& label) const {
        Quantity_Color colour;
        for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
            if (colours_->GetColor(label, type, colour)) {
                return srgb(colour);
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] Colour colour_of(const TopoDS_Shape& shape) const {
        Quantity_Color colour;
        for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
            if (colours_->GetColor(shape, type, colour)) {
                return srgb(colour);
            }
        }
        return std::nullopt;
    }

    static Colour srgb(const Quantity_Color& colour) {
        std::array<double, 3> out{};
        colour.Values(out[0], out[1], out[2], Quantity_TOC_sRGB);
        return out;
    }

    void visit(const TDF_Label& label, const TopLoc_Location& place, const std::string& instance,
               const Colour& inherited) {
        const Colour own = colour_of(label);
        const Colour& colour = own ? own : inherited;
        if (XCAFDoc_ShapeTool::IsAssembly(label)) {
            TDF_LabelSequence components;
            XCAFDoc_ShapeTool::GetComponents(label, components);
            for (int i = 1; i <= components.Length(); ++i) {
                const TDF_Label& component = components.Value(i);
                TDF_Label referred;
                if (XCAFDoc_ShapeTool::GetReferredShape(component, referred)) {
                    const Colour placed = colour_of(component);
                    visit(referred, place * XCAFDoc_ShapeTool::GetLocation(component),
                          name_of(component), placed ? placed : colour);
                }
            }
            return;
        }
        const std::string product = name_of(label);
        const std::string& name = product.empty() ? instance : product;
        const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
        const std::size_t before = contents_.solids.size();
        add_shape(shape.Located(place * shape.Location()), name, colour, contents_);
        // A colour may hang on the solid inside the product.
        std::size_t at = before;
        for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More() && at < contents_.solids.size();
             it.Next(), ++at) {
            if (const Colour of_solid = colour_of(it.Current())) {
                contents_.solids[at].colour = of_solid;
            }
        }
    }

    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colours_;
    Contents& contents_;
};

tl::unexpected<Error> unreadable(std::string_view name, const std::string& reason) {
    return fail("brep.unreadable", "the geometry kernel cannot read the file: " + reason,
                std::string(name), "export it again; AP203, AP214 and AP242 solids are read");
}

Result<Contents> read_step(std::string_view bytes, std::string_view name) {
    STEPCAFControl_Reader reader;
    reader.SetNameMode(true);
    reader.SetColorMode(true);
    reader.SetLayerMode(false);
    reader.SetPropsMode(false);
    std::istringstream stream{std::string(bytes)};
    if (reader.ChangeReader().ReadStream("model", stream) != IFSelect_RetDone) {
        return unreadable(name, "its entities are out of shape");
    }
    Handle(TDocStd_Document) document = new TDocStd_Document("XmlXCAF");
    if (!reader.Transfer(document)) {
        return unreadable(name, "it holds no product that can be made a shape");
    }
    Contents contents;
    DocumentWalk(document, contents).walk();
    return contents;
}

Result<Contents> read_cascade(std::string_view bytes, std::string_view name) {
    std::istringstream stream{std::string(bytes)};
    TopoDS_Shape shape;
    BRepTools::Read(shape, stream, BRep_Builder());
    if (shape.IsNull()) {
        return unreadable(name, "its shape is empty or out of shape");
    }
    Contents contents;
    add_shape(shape, {}, std::nullopt, contents);
    return contents;
}

/// Every body gets a name of its own.
void name_bodies(std::vector<Found>& solids) {
    std::map<std::string, int> used;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        std::string name =
            solids[i].name.empty() ? "body " + std::to_string(i + 1) : solids[i].name;
        const std::string base = name;
        while (used.contains(name)) {
            name = base + " (" + std::to_string(++used[base]) + ")";
        }
        used[name] = 1;
        solids[i].name = name;
    }
}

Status choose_body(std::vector<Found>& solids, const std::string& body, std::string_view name) {
    if (body.empty() || body == "all") {
        return {};
    }
    std::vector<std::string> names;
    for (const Found& found : solids) {
        names.push_back(found.name);
        if (found.name == body) {
            const Found chosen = found;
            solids = {chosen};
            return {};
        }
    }
    constexpr std::size_t kShown = 12;
    std::string list;
    for (std::size_t i = 0; i < names.size() && i < kShown; ++i) {
        list += (i == 0 ? "'" : ", '") + names[i] + "'";
    }
    return fail("brep.no_such_body", "the file has no body '" + body + "'", std::string(name),
                "bodies are " + list + (names.size() > kShown ? ", ..." : "") + ". " +
                    did_you_mean(body, names));
}

double diagonal_of(const std::vector<Found>& solids) {
    Bnd_Box box;
    for (const Found& found : solids) {
        BRepBndLib::Add(found.solid, box, false);
    }
    return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

Result<std::vector<Body>> read_bodies(std::string_view bytes, FileKind kind, std::string_view name,
                                      const BrepReadOptions& options, const Run& run) {
    auto contents = kind == FileKind::Step ? read_step(bytes, name) : read_cascade(bytes, name);
    if (!contents) {
        return fail(contents.error());
    }
    const std::string outside = std::to_string(contents->faces_outside) +
                                " faces of open sheets, " +
                                std::to_string(contents->edges_outside) + " edges of wires";
    if (contents->solids.empty()) {
        return fail("brep.no_solid", "the file holds no solid: " + outside, std::string(name),
                    "close and sew the sheets into a solid in a CAD program");
    }
    if (contents->faces_outside + contents->edges_outside > 0) {
        run.warn(std::string(name) + ": left out what is no solid: " + outside);
    }
    name_bodies(contents->solids);
    if (const Status chosen = choose_body(contents->solids, options.body, name); !chosen) {
        return fail(chosen.error());
    }
    const double deflection_mm =
        options.deflection_mm.value_or(default_deflection_mm(diagonal_of(contents->solids)));
    std::vector<Body> bodies;
    for (const Found& found : contents->solids) {
        if (run.cancelled()) {
            return cancelled();
        }
        auto mesh = triangles_of(found.solid, deflection_mm, options.angle,
                                 std::string(name) + ": " + found.name);
        if (!mesh) {
            return fail(mesh.error());
        }
        bodies.push_back({found.name, found.colour, std::move(*mesh),
                          options.measured ? figures_of(found.solid) : BodyFigures{}});
    }
    return bodies;
}

}  // namespace

std::unique_lock<std::mutex> prepare_occt() {
    static std::mutex one_at_a_time;
    std::unique_lock lock(one_at_a_time);
    static std::once_flag once;
    std::call_once(once, [] {
        Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
        // Before the controller exists, its parameters cannot be set.
        STEPCAFControl_Controller::Init();
        Interface_Static::SetCVal("xstep.cascade.unit", "MM");
        // The reader mends what it reads. Turning the faces of a shell one against the other is
        // quadratic, and shells of solids are oriented: of all steps, those two are left out.
        const Handle(ShapeProcess_ShapeContext) context = new ShapeProcess_ShapeContext("STEP");
        const Handle(Resource_Manager) settings = context->ResourceManager();
        settings->SetResource("FromSTEP.exec.op", "FixShape");
        settings->SetResource("FromSTEP.FixShape.FixFaceOrientationMode", 0);
        settings->SetResource("FromSTEP.FixShape.FixShellOrientationMode", 0);
    });
    return lock;
}

Result<std::vector<Body>> read_with_occt(std::string_view bytes, FileKind kind,
                                         std::string_view name, const BrepReadOptions& options,
                                         const Run& run) {
    const auto lock = prepare_occt();
    try {
        return read_bodies(bytes, kind, name, options, run);
    } catch (const Standard_Failure& failure) {
        return unreadable(name, failure.GetMessageString());
    }
}

}  // namespace decomp::brep
