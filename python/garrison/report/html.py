"""Pieces of an HTML page."""

import base64
import html
import io
from collections.abc import Iterable
from typing import Any

STYLE = """
body{font:16px/1.5 system-ui,sans-serif;color:#1a1a1a;max-width:62rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.7rem;margin-bottom:.2rem}h2{font-size:1.2rem;margin-top:2.2rem}
p.lead{font-size:1.1rem}.wide{overflow-x:auto;-webkit-overflow-scrolling:touch}
table{border-collapse:collapse;width:100%;font-size:.92rem}
th,td{padding:.35rem .6rem;border-bottom:1px solid #ddd;text-align:right;vertical-align:top}
th:first-child,td:first-child{text-align:left}td.words,th.words{text-align:left}
svg,img{max-width:100%;height:auto}figure{margin:1rem 0}figcaption{color:#555;font-size:.9rem}
.doubt{border-left:4px solid #D55E00;padding:.1rem .8rem;margin:.6rem 0}
footer{color:#777;font-size:.85rem;margin-top:3rem}
@media(max-width:600px){body{margin:1rem auto;padding:0 .7rem}
table{width:auto;min-width:100%}td,th{padding:.3rem .45rem}}
"""


def table(head: Iterable[str], cells: Iterable[Iterable[str]], words: int = 1) -> str:
    """A table that scrolls by itself where the screen is narrow; the first `words` columns are text."""

    def line(tag: str, entries: Iterable[str]) -> str:
        classes = ((' class="words"' if k < words else "", e) for k, e in enumerate(entries))
        return "<tr>" + "".join(f"<{tag}{c}>{html.escape(e)}</{tag}>" for c, e in classes) + "</tr>"

    body = "".join(line("td", row) for row in cells)
    return f'<div class="wide"><table><thead>{line("th", head)}</thead><tbody>{body}</tbody></table></div>'


def figure(picture: Any, note: str = "") -> str:
    """A matplotlib figure as SVG, with a caption."""
    buffer = io.StringIO()
    picture.savefig(buffer, format="svg")
    text = buffer.getvalue()
    caption = f"<figcaption>{html.escape(note)}</figcaption>" if note else ""
    return f'<figure><div class="wide">{text[text.index("<svg") :]}</div>{caption}</figure>'


def image(data: bytes, kind: str, description: str) -> str:
    """A picture inside the page."""
    text = base64.b64encode(data).decode()
    return f'<figure><img alt="{html.escape(description)}" src="data:image/{kind};base64,{text}"></figure>'


def page(title: str, sections: Iterable[str]) -> str:
    """The whole page."""
    meta = '<meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">'
    head = f"<head>{meta}<title>{html.escape(title)}</title><style>{STYLE}</style></head>"
    return f'<!doctype html><html lang="en">{head}<body>{"".join(sections)}</body></html>'
