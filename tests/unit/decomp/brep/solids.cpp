// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/decomp/brep/solids.h"

#include "tests/support/temp_dir.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Pln.hxx>

#include <cmath>
#include <fstream>
#include <sstream>

namespace tests {

namespace {

void prepare() {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
    STEPCAFControl_Controller::Init();
    Interface_Static::SetCVal("write.step.unit", "MM");
    Interface_Static::SetCVal("write.step.schema", "AP214IS");
}

std::string contents_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

std::string step_of(const TopoDS_Shape& shape, const std::string& unit = "MM",
                    const std::string& schema = "AP214IS") {
    prepare();
    Interface_Static::SetCVal("write.step.unit", unit.c_str());
    Interface_Static::SetCVal("write.step.schema", schema.c_str());
    const TempDir dir;
    const std::string path = (dir / "shape.step").string();
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    writer.Write(path.c_str());
    return contents_of(path);
}

TopoDS_Shape holed_block() {
    const gp_Ax2 axis(gp_Pnt(50, 30, -10), gp_Dir(0, 0, 1));
    return BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(100, 60, 20).Shape(),
                           BRepPrimAPI_MakeCylinder(axis, 8, 40).Shape())
        .Shape();
}

TopoDS_Shape sheet() {
    return BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0, 10, 0, 10).Shape();
}

}  // namespace

std::string holed_block_step(const std::string& unit, const std::string& schema) {
    return step_of(holed_block(), unit, schema);
}

std::string holed_block_brep() {
    std::ostringstream out;
    BRepTools::Write(holed_block(), out);
    return out.str();
}

std::string rounded_plate_step() {
    const TopoDS_Shape block = BRepPrimAPI_MakeBox(80, 50, 20).Shape();
    BRepFilletAPI_MakeFillet fillet(block);
    for (TopExp_Explorer it(block, TopAbs_EDGE); it.More(); it.Next()) {
        fillet.Add(4, TopoDS::Edge(it.Current()));
    }
    TopoDS_Shape shape = fillet.Shape();
    for (const double x : {15.0, 65.0}) {
        for (const double y : {12.0, 38.0}) {
            const gp_Ax2 axis(gp_Pnt(x, y, -10), gp_Dir(0, 0, 1));
            shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(axis, 3, 40).Shape()).Shape();
        }
    }
    return step_of(shape);
}

std::string assembly_step() {
    prepare();
    const Handle(TDocStd_Document) document = new TDocStd_Document("XmlXCAF");
    const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    const auto colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
    const TDF_Label base = shapes->AddShape(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), false);
    const TDF_Label pin = shapes->AddShape(BRepPrimAPI_MakeCylinder(2, 8).Shape(), false);
    TDataStd_Name::Set(base, "base");
    TDataStd_Name::Set(pin, "pin");
    colours->SetColor(base, Quantity_Color(1, 0, 0, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
    colours->SetColor(pin, Quantity_Color(0, 0, 1, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
    const TDF_Label all = shapes->NewShape();
    TDataStd_Name::Set(all, "all");
    gp_Trsf moved;
    moved.SetTranslation(gp_Vec(20, 0, 0));
    gp_Trsf turned;
    turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), std::acos(0.0));
    turned.SetTranslationPart(gp_Vec(40, 0, 0));
    shapes->AddComponent(all, base, TopLoc_Location());
    shapes->AddComponent(all, pin, TopLoc_Location(moved));
    shapes->AddComponent(all, pin, TopLoc_Location(turned));
    shapes->UpdateAssemblies();
    const TempDir dir;
    const std::string path = (dir / "assembly.step").string();
    STEPCAFControl_Writer writer;
    writer.SetColorMode(true);
    writer.SetNameMode(true);
    writer.Transfer(document, STEPControl_AsIs);
    writer.Write(path.c_str());
    return contents_of(path);
}

std::string sheet_step() { return step_of(sheet()); }

std::string wire_step() {
    return step_of(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape());
}

std::string mixed_step() {
    TopoDS_Compound both;
    BRep_Builder builder;
    builder.MakeCompound(both);
    builder.Add(both, holed_block());
    builder.Add(both, sheet());
    return step_of(both);
}

}  // namespace tests
