// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/occt_detail.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Trsf.hxx>

#include <sstream>

namespace decomp::brep {

namespace {

const char* name_of(StepSchema schema) {
    switch (schema) {
        case StepSchema::Ap203:
            return "AP203";
        case StepSchema::Ap242:
            return "AP242DIS";
        case StepSchema::Ap214:
            break;
    }
    return "AP214IS";
}

TopLoc_Location location_of(const Eigen::Isometry3d& map) {
    const auto& m = map.matrix();
    gp_Trsf motion;
    motion.SetValues(m(0, 0), m(0, 1), m(0, 2), m(0, 3), m(1, 0), m(1, 1), m(1, 2), m(1, 3),
                     m(2, 0), m(2, 1), m(2, 2), m(2, 3));
    // The rotation's last digits are no scaling, which the kernel refuses.
    motion.SetScaleFactor(1);
    return {motion};
}

void name(const TDF_Label& label, const std::string& text) {
    TDataStd_Name::Set(label, TCollection_ExtendedString(text.c_str(), true));
}

/// A clock would make every run's file another one.
void write_header(const Handle(StepData_StepModel) & model, const std::string& title) {
    APIHeaderSection_MakeHeader header(model);
    const auto text = [](const std::string& value) {
        return new TCollection_HAsciiString(value.c_str());
    };
    header.SetName(text(title));
    header.SetTimeStamp(text("2000-01-01T00:00:00"));
    header.SetAuthorValue(1, text(""));
    header.SetOrganizationValue(1, text(""));
    header.SetOriginatingSystem(text("Hew"));
    header.SetPreprocessorVersion(text("Hew"));
    header.SetAuthorisation(text(""));
    header.SetDescriptionValue(1, text("parts cut by Hew"));
    header.Apply(model);
}

Result<StepFile> write_bodies(const std::vector<StepBody>& bodies, const std::string& title,
                              StepSchema schema, const Run& run) {
    Interface_Static::SetCVal("write.step.schema", name_of(schema));
    Interface_Static::SetCVal("write.step.unit", "MM");
    // Curves on surfaces are made by every reader anew; to write them would double the file.
    Interface_Static::SetIVal("write.surfacecurve.mode", 0);
    const Handle(TDocStd_Document) document = new TDocStd_Document("XmlXCAF");
    const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    const auto colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
    TDF_Label all;
    const bool assembled =
        bodies.size() > 1 || !bodies.at(0).placed_from_solid.matrix().isIdentity(0);
    if (assembled) {
        all = shapes->NewShape();
        name(all, title);
    }
    StepFile file;
    for (const StepBody& body : bodies) {
        if (run.cancelled()) {
            return cancelled();
        }
        const TopoDS_Shape shape = shape_of(body.solid);
        file.figures.push_back(body.measured ? figures_of(shape) : BodyFigures{});
        const TDF_Label label = shapes->AddShape(shape, false);
        name(label, body.name);
        if (body.colour && schema != StepSchema::Ap203) {
            const auto& [r, g, b] = *body.colour;
            colours->SetColor(label, Quantity_Color(r, g, b, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
        }
        if (!all.IsNull()) {
            const TDF_Label component =
                shapes->AddComponent(all, label, location_of(body.placed_from_solid));
            name(component, body.name);
        }
    }
    shapes->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    writer.SetColorMode(schema != StepSchema::Ap203);
    writer.SetNameMode(true);
    writer.SetLayerMode(false);
    writer.SetPropsMode(false);
    if (!writer.Transfer(document, STEPControl_AsIs)) {
        return fail("brep.not_written", "the geometry kernel cannot write the solid", title);
    }
    const Handle(StepData_StepModel) model = writer.ChangeWriter().Model();
    write_header(model, title);
    StepData_StepWriter text(model);
    text.SendModel(Handle(StepData_Protocol)::DownCast(writer.ChangeWriter().WS()->Protocol()));
    std::ostringstream out;
    text.Print(out);
    file.text = out.str();
    return file;
}

}  // namespace

Result<StepFile> write_with_occt(const std::vector<StepBody>& bodies, const std::string& title,
                                 StepSchema schema, const Run& run) {
    const auto lock = prepare_occt();
    try {
        return write_bodies(bodies, title, schema, run);
    } catch (const Standard_Failure& failure) {
        return fail("brep.not_written",
                    std::string("the geometry kernel cannot write the solid: ") +
                        failure.GetMessageString(),
                    title);
    }
}

}  // namespace decomp::brep
