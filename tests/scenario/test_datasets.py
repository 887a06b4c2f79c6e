"""Public sets of orders: each layout of columns, on small files written by hand."""

from __future__ import annotations

from datetime import datetime

import pytest

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.scenario import load, sku_set
from rmfs.scenario.datasets import LAYOUTS, convert
from rmfs.scenario.sources import order_stream

ORDERS = """order_id,user_id,eval_set,order_number,order_dow,order_hour_of_day,days_since_prior
11,1,prior,1,2,08,
12,1,prior,2,2,08,15.0
13,2,prior,1,0,23,
14,2,test,2,6,00,3.0
"""
PRIOR = """order_id,product_id,add_to_cart_order,reordered
12,196,1,0
12,14084,2,0
11,196,1,0
13,46149,1,1
99,196,1,1
"""
RETAIL = (
    "InvoiceNo,StockCode,Description,Quantity,InvoiceDate,UnitPrice,CustomerID,Country\n"
    "536366,22633,HAND WARMER,6,12/1/2010 8:28,1.85,17850,United Kingdom\n"
    '536365,85123A,"HEART, WHITE",6,12/1/2010 8:26,2.55,17850,United Kingdom\n'
    "536365,71053,LANTERN,2,12/1/2010 8:26,3.39,17850,United Kingdom\n"
    "536365,85123A,HEART,4,12/1/2010 8:26,2.55,17850,United Kingdom\n"
    "536365,POST,POSTAGE,1,12/1/2010 8:26,18,17850,United Kingdom\n"
    "C536379,22633,HAND WARMER,-1,12/1/2010 9:41,1.85,14527,United Kingdom\n"
    "536414,22139,\xa3 lost,-56,12/1/2010 11:52,0,,United Kingdom\n"
)
RETAIL_2 = """Invoice,StockCode,Description,Quantity,InvoiceDate,Price,Customer ID,Country
489434,85048,"15CM ""GLASS"" BALL",12,2009-12-01 07:45:00,6.95,13085.0,United Kingdom
"""
JD = """order_ID,user_ID,sku_ID,order_date,order_time,quantity,type,promise,gift_item,dc_ori,dc_des
d0cf5cc6db,0abe9ef2ce,581d5b54c1,2018-03-01,2018-03-01 17:14:25.0,1,2,-,0,4,28
7444318d01,33a9e56257,067b673f2b,2018-03-01,2018-03-01 11:10:40.0,2,1,2,0,18,18
7444318d01,33a9e56257,623d0a582a,2018-03-01,2018-03-01 11:10:40.0,1,1,2,1,18,18
"""
OLIST = """"order_id","customer_id","order_status","order_purchase_timestamp","order_approved_at"
"e481","9ef4","delivered","2017-10-02 10:56:33","2017-10-02 11:07:15"
"53cd","b083","canceled","2018-07-24 20:41:37",""
"47ac","41ce","delivered","2017-09-08 08:38:49","2017-09-08 08:55:23"
"""
ITEMS = """"order_id","order_item_id","product_id","seller_id","shipping_limit_date","price"
"e481",1,"87285b","3504c0","2017-10-06 11:07:15",29.99
"e481",2,"87285b","3504c0","2017-10-05 11:07:15",29.99
"53cd",1,"595fac","289cdb","2018-07-30 03:24:27",118.70
"47ac",1,"aa4383","4869f7","2017-09-01 00:00:00",159.90
"""
SETS = {
    "instacart": (ORDERS, PRIOR),
    "online-retail": (RETAIL,),
    "jd": (JD,),
    "olist": (OLIST, ITEMS),
}
EXPECTED = {
    "instacart": (
        "84600.000,13,46149,1,\n"
        "202500.000,11,196,1,\n"
        "204300.000,12,196,1,\n"
        "204300.000,12,14084,1,\n"
    ),
    "online-retail": (
        "2010-12-01T08:26:00,536365,85123A,10,\n"
        "2010-12-01T08:26:00,536365,71053,2,\n"
        "2010-12-01T08:28:00,536366,22633,6,\n"
    ),
    "jd": (
        "2018-03-01T11:10:40,7444318d01,067b673f2b,2,\n"
        "2018-03-01T11:10:40,7444318d01,623d0a582a,1,\n"
        "2018-03-01T17:14:25,d0cf5cc6db,581d5b54c1,1,\n"
    ),
    "olist": (
        "2017-09-08T08:38:49,47ac,aa4383,1,\n"
        "2017-10-02T10:56:33,e481,87285b,2,2017-10-05T11:07:15\n"
    ),
}
LEFT_OUT = {
    "instacart": {"lines of orders that are not used": 1, "orders without a line": 1},
    "online-retail": {
        "lines that are not products (postage, fees)": 1,
        "lines of cancelled or corrected invoices": 1,
        "lines that are returns": 1,
    },
    "jd": {},
    "olist": {
        "orders cancelled or not available": 1,
        "lines of orders that are not used": 1,
    },
}


def written(folder, texts):
    paths = []
    for number, text in enumerate(texts):
        paths.append(folder / f"{number}.csv")
        paths[-1].write_bytes(text.encode("latin-1"))
    return paths


def test_every_layout_is_tested():
    assert set(SETS) == set(EXPECTED) == set(LEFT_OUT) == set(LAYOUTS)


@pytest.mark.parametrize("layout", SETS)
def test_a_set_becomes_orders(tmp_path, layout):
    out = tmp_path / "orders.csv"
    done = convert(layout, written(tmp_path, SETS[layout]), out)
    assert out.read_text() == "time,order,sku,quantity,due\n" + EXPECTED[layout]
    assert done.left_out == LEFT_OUT[layout]
    lines = EXPECTED[layout].splitlines()
    assert done.lines == len(lines)
    assert done.orders == len({line.split(",")[1] for line in lines})
    assert done.units == sum(int(line.split(",")[3]) for line in lines)
    assert (done.first, done.last) == (lines[0].split(",")[0], lines[-1].split(",")[0])


@pytest.mark.parametrize("layout", SETS)
def test_what_is_written_is_a_scenario_of_ours(tmp_path, layout):
    """Its orders are read, and its SKUs; a run would take them."""
    out = tmp_path / "orders.csv"
    done = convert(layout, written(tmp_path, SETS[layout]), out)
    text = 'format = "rmfs-scenario/1"\nduration_s = 2592000\n[skus]\nfile = "orders.csv"\n'
    (tmp_path / "own.toml").write_text(f'{text}[demand]\nmode = "stream"\nfile = "orders.csv"\n')
    scenario = load(tmp_path / "own.toml")
    skus = sku_set(scenario.skus)
    stream = order_stream(scenario, skus)
    assert (len(stream), len(skus)) == (done.orders, done.skus)
    assert stream.units.sum() == done.units


def test_the_second_set_of_online_retail_has_other_names(tmp_path):
    out = tmp_path / "orders.csv"
    convert("online-retail", written(tmp_path, [RETAIL, RETAIL_2]), out)
    assert out.read_text().splitlines()[1] == "2009-12-01T07:45:00,489434,85048,12,"


def test_a_part_of_a_set(tmp_path):
    out, paths = tmp_path / "orders.csv", written(tmp_path, SETS["jd"])
    noon = datetime(2018, 3, 1, 12)
    done = convert("jd", paths, out, begin=noon)
    assert (done.orders, done.left_out["orders not asked for"]) == (1, 1)
    done = convert("jd", paths, out, end=noon)
    assert (done.orders, done.lines) == (1, 2)
    many = JD.splitlines()[0] + "\n"
    many += "".join(f"o{n},u,s{n % 7},d,2018-03-01 17:14:25.0,1,2,-,0,4,2\n" for n in range(2000))
    paths = written(tmp_path, [many])
    some = convert("jd", paths, out, share=0.3, seed=4)
    assert 500 < some.orders < 700
    text = out.read_text()
    assert convert("jd", paths, out, share=0.3, seed=4) == some
    assert out.read_text() == text
    convert("jd", paths, out, share=0.3, seed=5)
    assert out.read_text() != text


WRONG = [
    ("jd", 0, "quantity,type", "amount,type", "line 1: column quantity is missing"),
    ("jd", 0, "order_date", "order_time", "line 1: column order_time occurs twice"),
    ("jd", 0, "17:14:25.0,1", "17:14:25.0,0", "line 2: quantity must be a whole number"),
    ("jd", 0, "17:14:25.0,1", "17:14:25.0,1.5", "line 2: quantity must be a whole number"),
    ("jd", 0, "2018-03-01 17:14:25.0", "yesterday", "line 2: order_time must be a time"),
    ("jd", 0, "581d5b54c1", "", "line 2: sku_ID must have 1 to 200"),
    ("jd", 0, ",4,28", ",4", "line 2: 10 fields, expected 11"),
    ("jd", 0, "7444318d01", '"7444', "line"),
    ("online-retail", 0, "12/1/2010 8:26", "13/13/2010 8:26", "line 3: InvoiceDate must be a time"),
    ("online-retail", 0, ",6,12/1", ",six,12/1", "line 2: Quantity must be a whole number"),
    ("instacart", 0, "prior,1,2,08", "prior,1,7,08", "line 2: order_dow must be a whole number"),
    ("instacart", 0, "12,1,prior", "11,1,prior", "line 3: order_id occurs twice"),
    ("instacart", 1, "12,14084", "12,196", "line 3: product_id occurs twice in its order"),
    ("olist", 0, "47ac", "e481", "line 4: order_id occurs twice"),
    ("olist", 1, '"47ac"', '"none"', "line 5: order_id none is not in"),
    ("olist", 1, "2017-09-01 00:00:00", "", "line 5: shipping_limit_date must be a time"),
]


@pytest.mark.parametrize(("layout", "file", "old", "new", "told"), WRONG)
def test_what_is_wrong_is_told_in_one_line(tmp_path, layout, file, old, new, told):
    texts = list(SETS[layout])
    assert old in texts[file]
    texts[file] = texts[file].replace(old, new, 1)
    paths = written(tmp_path, texts)
    with pytest.raises(InputError) as error:
        convert(layout, paths, tmp_path / "orders.csv")
    assert told in str(error.value)
    assert str(paths[file]) in str(error.value)
    assert "\n" not in str(error.value)
    assert not (tmp_path / "orders.csv").exists()


def test_other_refusals(tmp_path):
    paths = written(tmp_path, SETS["instacart"])
    out = tmp_path / "orders.csv"
    with pytest.raises(InputError, match="valid: instacart, online-retail, jd, olist"):
        convert("amazon", paths, out)
    with pytest.raises(InputError, match="needs 2 files: orders"):
        convert("instacart", paths[:1], out)
    with pytest.raises(InputError, match="no dates"):
        convert("instacart", paths, out, begin=datetime(2018, 1, 1))
    with pytest.raises(InputError, match="must end in"):
        convert("instacart", paths, tmp_path / "orders.txt")
    with pytest.raises(InputError, match="no such file"):
        convert("jd", [tmp_path / "none.csv"], out)
    with pytest.raises(InputError, match="left out: 2 orders not asked for"):
        convert("jd", written(tmp_path, SETS["jd"]), out, end=datetime(2000, 1, 1))
    (tmp_path / "bad.csv").write_bytes(b"order_ID\xff\n")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        convert("jd", [tmp_path / "bad.csv"], out)


def test_the_command(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files = [str(path) for path in written(tmp_path, SETS["olist"])]
    assert main(["scenario", "convert", "olist", *files]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0] == (
        "orders.csv: 2 orders, 2 lines, 3 units, 2 SKUs, "
        "from 2017-09-08T08:38:49 to 2017-10-02T10:56:33"
    )
    assert "left out: 1 orders cancelled or not available" in told
    assert main(["scenario", "convert", "olist", *files]) == 2
    assert "exists already" in capsys.readouterr().err
    assert main(["scenario", "convert", "olist", *files, "--from", "2017-10-01", "--force"]) == 0
    assert capsys.readouterr().out.startswith("orders.csv: 1 orders")
