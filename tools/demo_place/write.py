"""The place's files: GeoTIFF rasters, GeoJSON waters in degrees, a GeoPackage of land use, a greyscale picture of moisture."""
from pathlib import Path

import numpy as np
from osgeo import gdal, ogr, osr

from .ground import SOILS
from .landuse import NAMES
from .noise import blur
from .relief import HEIGHT, WIDTH

# An invented place, laid into an empty-looking corner of the real grid so that coordinates are realistic.
EPSG, WEST, SOUTH = 25832, 570000, 5725000

gdal.UseExceptions()
ogr.UseExceptions()
gdal.SetConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z")  # same bytes every time
gdal.SetConfigOption("GDAL_PAM_ENABLED", "NO")


def reference(epsg):
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(epsg)
    srs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return srs


def raster(path, array, kind, options=(), scale=None, palette=None, description=""):
    """Writes the array as GeoTIFF; `scale` makes file values of the true ones (true = file * scale)."""
    rows, cols = array.shape
    cell = WIDTH / cols
    path.unlink(missing_ok=True)
    data = gdal.GetDriverByName("GTiff").Create(
        str(path), cols, rows, 1, kind, ["COMPRESS=DEFLATE", "ZLEVEL=9", "TILED=NO", "BLOCKYSIZE=64", *options])
    data.SetGeoTransform((WEST, cell, 0, SOUTH + HEIGHT, 0, -cell))
    data.SetProjection(reference(EPSG).ExportToWkt())
    band = data.GetRasterBand(1)
    if description:
        band.SetDescription(description)
    if scale:
        band.SetScale(scale)
        band.SetOffset(0)
        array = np.rint(array / scale)
    if palette:
        table = gdal.ColorTable()
        for code, colour in palette.items():
            table.SetColorEntry(code, colour + (255,))
        band.SetColorTable(table)
    band.WriteArray(array.astype({gdal.GDT_Float32: "f4", gdal.GDT_Byte: "u1"}[kind]))
    data = None


def picture(path, array):
    """An 8-bit greyscale PNG without georeference."""
    path.unlink(missing_ok=True)
    memory = gdal.GetDriverByName("MEM").Create("", array.shape[1], array.shape[0], 1, gdal.GDT_Byte)
    memory.GetRasterBand(1).WriteArray(np.rint(np.clip(array, 0, 1) * 255).astype("u1"))
    gdal.GetDriverByName("PNG").CreateCopy(str(path), memory, options=["ZLEVEL=9"])


def map_box():
    return ogr.CreateGeometryFromWkt("POLYGON((%f %f,%f %f,%f %f,%f %f,%f %f))" % (
        WEST, SOUTH, WEST + WIDTH, SOUTH, WEST + WIDTH, SOUTH + HEIGHT, WEST, SOUTH + HEIGHT, WEST, SOUTH))


def line_geometry(points):
    line = ogr.Geometry(ogr.wkbLineString)
    for px, py in points:
        line.AddPoint_2D(WEST + px, SOUTH + py)
    return line


def outlines(mask, relief, least_m2, simplify_m=2.5):
    """Smooth polygons around a mask on the relief's grid."""
    smooth = blur(mask, 1)
    rows, cols = mask.shape
    data = gdal.GetDriverByName("MEM").Create("", cols, rows, 1, gdal.GDT_Byte)
    data.SetGeoTransform((WEST - relief.margin, relief.cell, 0, SOUTH + HEIGHT + relief.margin, 0, -relief.cell))
    data.GetRasterBand(1).WriteArray((smooth > 0.5).astype("u1"))
    store = ogr.GetDriverByName("Memory").CreateDataSource("")
    layer = store.CreateLayer("outlines", None, ogr.wkbPolygon)
    gdal.Polygonize(data.GetRasterBand(1), data.GetRasterBand(1), layer, -1)
    shapes = []
    for feature in layer:
        shape = feature.GetGeometryRef().Buffer(4).Buffer(-8).Buffer(4).Simplify(simplify_m)
        for part in parts(shape.Intersection(map_box())):
            if part.GetArea() >= least_m2:
                shapes.append(part)
    return sorted(shapes, key=lambda s: s.GetEnvelope())


def parts(geometry):
    """The single polygons or lines of a geometry, flat."""
    if geometry is None or geometry.IsEmpty():
        return []
    if geometry.GetGeometryCount() and geometry.GetGeometryType() not in (ogr.wkbPolygon, ogr.wkbPolygon25D):
        return [p for k in range(geometry.GetGeometryCount()) for p in parts(geometry.GetGeometryRef(k).Clone())]
    return [geometry.Clone()]


def vectors(path, driver, layers, epsg=EPSG, options=()):
    """layers: name -> (geometry type, {attribute: OGR type}, [(values, geometry in the map's coordinates)])."""
    path.unlink(missing_ok=True)
    data = ogr.GetDriverByName(driver).CreateDataSource(str(path))
    turn = osr.CoordinateTransformation(reference(EPSG), reference(epsg))
    for name, (kind, attributes, features) in layers.items():
        layer = data.CreateLayer(name, reference(epsg), kind, list(options))
        for attribute, of in attributes.items():
            layer.CreateField(ogr.FieldDefn(attribute, of))
        for values, geometry in features:
            feature = ogr.Feature(layer.GetLayerDefn())
            for attribute, value in values.items():
                feature.SetField(attribute, value)
            geometry = geometry.Clone()
            geometry.FlattenTo2D()
            if epsg != EPSG:
                geometry.Transform(turn)
            feature.SetGeometry(geometry)
            layer.CreateFeature(feature)
    data = None


def halved(array):
    return array.reshape(array.shape[0] // 2, 2, array.shape[1] // 2, 2).mean(axis=(1, 3))


def write(folder, relief, water, ground, use):
    folder = Path(folder)
    m = int(relief.margin / relief.cell)
    window = np.s_[m:-m, m:-m]
    # A thirty-second of a metre is finer than the relief is true, and compresses well.
    raster(folder / "elevation.tif", np.rint(relief.height[window] * 32) / 32, gdal.GDT_Float32, ["PREDICTOR=3"],
           description="height above sea level, m")
    raster(folder / "moisture.tif", ground.moisture[window], gdal.GDT_Byte, ["PREDICTOR=2"], scale=0.05,
           description="moisture, Ellenberg F")
    for name, field, title in (("reaction", ground.reaction, "R"), ("nutrients", ground.nutrients, "N")):
        raster(folder / f"{name}.tif", halved(field[window]), gdal.GDT_Byte, ["PREDICTOR=2"], scale=0.05,
               description=f"{name}, Ellenberg {title}")
    raster(folder / "soil.tif", ground.soil[window], gdal.GDT_Byte, palette={k: v[1] for k, v in SOILS.items()}, description="soil type")
    picture(folder / "water.png", (halved(ground.moisture[window]) - 2) / 8)
    (folder / "soil_codes.csv").write_text("code,soil\n" + "".join(f"{k},{v[0]}\n" for k, v in SOILS.items()))

    river = line_geometry(relief.river).Buffer(6.5, 6).Simplify(0.6).Intersection(map_box())
    standing = [({"kind": "pond"}, s) for s in outlines(water.pond, relief, 500)]
    standing += [({"kind": "oxbow"}, s) for s in outlines(water.oxbow, relief, 300, 1.5)]
    vectors(folder / "waters.geojson", "GeoJSON", {"waters": (ogr.wkbPolygon, {"kind": ogr.OFTString}, [
        *(({"kind": "river"}, p) for p in parts(river)), *standing])}, 4326, ["RFC7946=YES", "COORDINATE_PRECISION=6"])
    brooks = [({"kind": "brook"}, p) for line in water.brooks for p in parts(line_geometry(line).Simplify(1).Intersection(map_box()))]
    vectors(folder / "brooks.geojson", "GeoJSON", {"brooks": (ogr.wkbLineString, {"kind": ogr.OFTString}, brooks)},
            4326, ["RFC7946=YES", "COORDINATE_PRECISION=6"])
    polygons = [({"code": code, "use": name}, s) for code, name in NAMES.items() for s in outlines(use.codes == code, relief, 800)]
    roads = [({"class": kind}, p) for kind, line in use.roads for p in parts(line_geometry(line).Simplify(0.8).Intersection(map_box()))]
    vectors(folder / "landuse.gpkg", "GPKG", {
        "land_use": (ogr.wkbPolygon, {"code": ogr.OFTInteger, "use": ogr.OFTString}, polygons),
        "roads": (ogr.wkbLineString, {"class": ogr.OFTString}, roads)})
