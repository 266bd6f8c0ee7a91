"""Pieces of an HTML page."""

import base64
import html
import io
import re
from collections.abc import Iterable
from typing import Any

_NUMBER = re.compile(r"[-+]?[\d.]*(e[-+]?\d+)?%?|-?inf|nan|-")
_LONG = 24  # letters
STYLE = """
:root{color-scheme:light dark;--text:#1a1a1a;--soft:#555;--line:#ddd;--page:#fff}
@media(prefers-color-scheme:dark){:root{--text:#e8e8e8;--soft:#b5b5b5;--line:#444;--page:#16181a}
svg,img{background:#fff;border-radius:4px}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--text);background:var(--page);max-width:62rem;margin:2rem auto;
padding:0 1rem}
h1{font-size:1.7rem;margin-bottom:.2rem}h2{font-size:1.2rem;margin-top:2.2rem}
p.lead{font-size:1.1rem}.wide{overflow-x:auto;-webkit-overflow-scrolling:touch}
table{border-collapse:collapse;width:100%;font-size:.92rem}
th,td{padding:.35rem .6rem;border-bottom:1px solid var(--line);text-align:right;vertical-align:top}
th:first-child,td:first-child{text-align:left}td.words,th.words{text-align:left}td.long{min-width:11rem}
svg,img{max-width:100%;height:auto}figure{margin:1rem 0}figcaption{color:var(--soft);font-size:.9rem}
.doubt{border-left:4px solid #D55E00;padding:.1rem .8rem;margin:.6rem 0}
footer{color:var(--soft);font-size:.85rem;margin-top:3rem}
@media(max-width:600px){body{margin:1rem auto;padding:0 .7rem}
table{width:auto;min-width:100%}td,th{padding:.3rem .45rem}
.wide>svg,.wide>img{max-width:none;width:42rem}}
@media print{body{margin:0;padding:0}.wide{overflow:visible}table{font-size:.72rem}td,th{padding:.25rem .4rem}
td.long{min-width:7rem}h2{break-after:avoid}figcaption{break-before:avoid}figure,tr{break-inside:avoid}svg,img{max-height:19cm}}
"""


def table(head: Iterable[str], cells: Iterable[Iterable[str]]) -> str:
    """A table that scrolls by itself where the screen is narrow; columns of numbers are aligned right."""
    rows, names = [list(row) for row in cells], list(head)
    columns = [[row[k] for row in rows] for k in range(len(names))]
    classes = [_class(column) for column in columns]

    def line(tag: str, entries: Iterable[str]) -> str:
        parts = (f"<{tag}{c}>{html.escape(e)}</{tag}>" for c, e in zip(classes, entries, strict=True))
        return "<tr>" + "".join(parts) + "</tr>"

    body = "".join(line("td", row) for row in rows)
    return f'<div class="wide"><table><thead>{line("th", names)}</thead><tbody>{body}</tbody></table></div>'


def _class(column: list[str]) -> str:
    """Columns with any words are text; those with long ones keep a width in which they can be read."""
    if all(_NUMBER.fullmatch(cell) for cell in column):
        return ""
    return ' class="words long"' if max(map(len, column), default=0) > _LONG else ' class="words"'


def figure(picture: Any, note: str = "") -> str:
    """A matplotlib figure as SVG, with a caption."""
    buffer = io.StringIO()
    picture.savefig(buffer, format="svg")
    text = buffer.getvalue()
    label = f' role="img" aria-label="{html.escape(note)}"' if note else ""
    caption = f"<figcaption>{html.escape(note)}</figcaption>" if note else ""
    return f'<figure><div class="wide"><svg{label}{text[text.index("<svg") + 4 :]}</div>{caption}</figure>'


def image(data: bytes, kind: str, description: str) -> str:
    """A picture inside the page."""
    text = base64.b64encode(data).decode()
    picture = f'<img alt="{html.escape(description)}" src="data:image/{kind};base64,{text}">'
    return f'<figure><div class="wide">{picture}</div></figure>'


def page(title: str, sections: Iterable[str]) -> str:
    """The whole page."""
    meta = '<meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">'
    head = f"<head>{meta}<title>{html.escape(title)}</title><style>{STYLE}</style></head>"
    return f'<!doctype html><html lang="en">{head}<body>{"".join(sections)}</body></html>'
