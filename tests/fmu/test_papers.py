"""What an FMU has for people and for other tools: icon, page, licence, what it depends on, its parameter set."""

from __future__ import annotations

import io
import re
import zipfile
from html import unescape

import numpy as np
import pytest
from hosts import OK, Host
from lxml import etree, html

from gw_exudyn import __version__
from gw_exudyn.fmi import icon, related
from gw_exudyn.fmi.page import rows
from gw_exudyn.fmi.prose import ENDINGS, LIMITS, METHOD
from gw_exudyn.fmi.variables import OUTPUT

SETS = f"{related.FOLDER}/{related.PARAMETERS}"


@pytest.fixture
def archive(fmu):
    with zipfile.ZipFile(fmu) as opened:
        yield opened


def test_the_icon_lies_where_the_standard_has_it_and_shows_every_line(archive, fmu):
    three = "sources/buildDescription.xml" in archive.namelist()
    content = archive.read("terminalsAndIcons/icon.png" if three else "model.png")
    # matplotlib reads PNG by the library that it draws with.
    from matplotlib.image import imread

    pixels = imread(io.BytesIO(content))
    assert pixels.shape == (2 * icon.SIZE, 2 * icon.SIZE, 4)
    assert 0.3 < (pixels[..., 3] == 0).mean() < 0.8  # most is transparent
    seen = {tuple(p) for p in np.rint(pixels[pixels[..., 3] == 1][:, :3] * 255).astype(int)}
    for line in icon.lines():
        assert tuple(int(line.colour[i : i + 2], 16) for i in (1, 3, 5)) in seen
    assert len(content) < 20_000
    if three:
        drawn = etree.fromstring(archive.read("terminalsAndIcons/icon.svg"))
        assert len(drawn.findall(".//{*}polyline")) == len(icon.lines())
        shown = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
        assert shown.find(".//Icon") is not None


def test_the_page_has_variables_method_limits_version_and_licence(archive, fmu):
    page = archive.read("documentation/index.html").decode()
    text = " ".join(unescape(re.sub(r"<[^>]+>", "", page)).split())
    for said in (*METHOD, *LIMITS, *(cell for row in ENDINGS for cell in row)):
        assert " ".join(said.replace("`", "").split()) in text
    assert f"gw-exudyn {__version__}" in text
    tree = html.fromstring(page)
    with Host(fmu) as host:
        names = [row[0].text_content() for row in tree.xpath('//div[@class="variables"]//tr[td]')]
        assert [name.partition("[7]")[0] for name in names] == list(host.variables)
    for link in [*tree.xpath("//a/@href"), *tree.xpath("//img/@src")]:
        place = "documentation/" + link
        while "/../" in place:
            place = re.sub(r"[^/]+/\.\./", "", place, count=1)
        assert place in archive.namelist(), link


def test_a_name_with_signs_of_html_stays_text():
    from gw_exudyn.fmi.description import Model
    from gw_exudyn.fmi.export import launch_of
    from gw_exudyn.fmi.page import documentation
    from gw_exudyn.fmi.variables import Variable

    model = Model("<b>&", "b", "", "1", "<i>", 1.0, 0.1, ())
    page = documentation(model, [Variable("<x>", "R", OUTPUT, "<script>")], 2, launch_of())
    assert "<b>" not in page
    assert "<script>" not in page
    assert rows([Variable("<x>", "R", OUTPUT, "")])[0][0] == "<x>"


def test_licence_and_dependencies_lie_where_the_standard_has_them(archive):
    assert "MIT License" in archive.read("documentation/licenses/license.txt").decode()
    needs = archive.read("documentation/externalDependencies.txt").decode()
    assert f"`pip install .` in a checkout of gw-exudyn {__version__}" in needs
    assert "GW_EXUDYN_PYTHON" in needs


def test_the_manifest_names_what_is_there(archive):
    """FMI-LS-REF: attributes of the root, and a file of its folder or, by a relative path, of the archive."""
    root = etree.fromstring(archive.read(f"{related.FOLDER}/{related.MANIFEST}"))
    space = "{http://fmi-standard.org/fmi-ls-manifest}"
    assert root.tag == "fmiReferences"
    assert root.get(f"{space}fmi-ls-name") == related.FOLDER.partition("/")[2] == "org.fmi-standard.fmi-ls-ref"
    assert re.fullmatch(r"1\.0\.0(-\S+)?", root.get(f"{space}fmi-ls-version"))
    roles = {}
    for element in root:
        place = f"{related.FOLDER}/{element.get('source')}"
        while "/../" in place:
            place = re.sub(r"[^/]+/\.\./", "", place, count=1)
        assert archive.read(place)
        roles[element.get("role")] = place
    assert roles == {"parameter": SETS, "model": "resources/scenario.json"}


def test_the_parameter_set_can_be_applied_as_it_is(archive, fmu):
    parameters = etree.fromstring(archive.read(SETS))
    readers = {"Real": float, "Integer": int, "Boolean": lambda text: text == "true", "String": str}
    values = {p.get("name"): readers[etree.QName(p[0]).localname](p[0].get("value")) for p in parameters[0]}
    with Host(fmu).start() as plain, Host(fmu).start(values) as applied:
        assert set(values) == {n for n, variable in plain.variables.items() if variable.causality == "parameter"}
        for host in (plain, applied):
            assert host.step(0.5)["status"] == OK
        assert applied.outputs() == plain.outputs()
