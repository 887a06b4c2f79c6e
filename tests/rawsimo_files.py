"""Files in RAWSim-O's formats, as small as they can be."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

XGENC = (
    "<SimpleItemGeneratorConfiguration><ItemDescriptions>"
    + "".join(f"<A><Key>{k}</Key><Value>1</Value></A>" for k in range(9))
    + "</ItemDescriptions></SimpleItemGeneratorConfiguration>"
)
XITEM = """<OrderList Type="Letter">
  <ItemDescriptions>
    <ItemDescription ID="4" Type="Letter" Weight="5" Letter="97" Color="Blue" />
    <ItemDescription ID="9" Type="Letter" Weight="2" Letter="98" Color="Red" />
  </ItemDescriptions>
  <ItemBundles><ItemBundle TimeStamp="1.5" ItemDescription="9" Size="3" /></ItemBundles>
  <Orders>
    <Order TimeStamp="2"><Positions>
      <Position ItemDescriptionID="9" Count="2" /><Position ItemDescriptionID="4" Count="1" />
    </Positions></Order>
    <Order TimeStamp="3.25"><Positions>
      <Position ItemDescriptionID="9" Count="1" />
    </Positions></Order>
  </Orders>
</OrderList>"""
WORDS = "ab\nba\n"
XSETT = (
    "<SettingConfiguration>{}<InventoryConfiguration>{}</InventoryConfiguration>{}"
    "</SettingConfiguration>"
)
XCONF = "<ControlConfiguration><Name>usual</Name></ControlConfiguration>"
XLAYO = """<LayoutConfiguration>
  <NameLayout>small</NameLayout><BotCount>4</BotCount><MaxAcceleration>0.5</MaxAcceleration>
  <CollisionPenaltyTime>0.5</CollisionPenaltyTime>
</LayoutConfiguration>"""


def resources(folder: Path) -> None:
    """Write the SKU set, the words and the order list that settings may name."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "Mu-1000.xgenc").write_text(XGENC)
    (folder / "Small.txt").write_text(WORDS)
    (folder / "list.xitem").write_text(XITEM)


def xsett(folder: Path, *, general: str = "", inventory: str = "", layout: str = "") -> Path:
    """Write a settings file, `test.xsett`, with its resources beside it."""
    resources(folder)
    path = folder / "test.xsett"
    more = f"<OverrideConfig>{layout}</OverrideConfig>" if layout else ""
    path.write_text(XSETT.format(general, inventory, more))
    return path
