//! The look of the report: that of the pages, in light and dark, on a phone and on paper.

/// The style sheet. Prints contain only the verdict, the errors, the forces and the friction of the first log.
pub const STYLE: &str = "\
:root{--panel:#fff;--text:#1b2128;--muted:#55606c;--line:#d9dfe6;--accent:#2f6fcb;--good:#1d7a4f;--bad:#b3261e;\
--c0:#2f6fcb;--c1:#d96a26;--c2:#2a8f63;--c3:#b83a5e;--c4:#7a52c7;--c5:#9a7b16;--c6:#16879b;--c7:#c253a6;--c8:#555d66;--c9:#111;\
color-scheme:light dark}\
@media (prefers-color-scheme:dark){:root{--panel:#171c22;--text:#e6eaef;--muted:#a5b1be;--line:#2c353f;--accent:#6aa5f5;\
--good:#5fcf98;--bad:#ff8a80;--c0:#6aa5f5;--c1:#f0924f;--c2:#4fc08d;--c3:#e8708f;--c4:#a98af0;--c5:#d0ac3a;--c6:#3fb9cc;\
--c7:#e283c8;--c8:#9aa4af;--c9:#f2f4f6}}\
*{box-sizing:border-box}\
body{margin:0;background:var(--panel);color:var(--text);font:15px/1.5 system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans',\
'DejaVu Sans',sans-serif}\
header{padding:10px 20px;border-bottom:1px solid var(--line)}h1{margin:0;font-size:18px}\
main{max-width:1080px;margin:0 auto;padding:14px 20px 60px}h2{font-size:16px;margin:26px 0 6px}p{margin:6px 0;color:var(--muted)}\
.verdict{border-left:5px solid var(--good);padding:4px 16px;margin:12px 0}.verdict.bad{border-color:var(--bad)}\
.answer{font-size:21px;line-height:1.3;color:var(--text);font-weight:600}\
.bad .answer{color:var(--bad)}ul{padding-left:20px;margin:6px 0}li{overflow-wrap:anywhere}li.warning{color:var(--bad)}\
figure{margin:8px 0}svg{width:100%;max-width:920px;height:auto;display:block}\
details{border-top:1px solid var(--line);margin-top:14px;padding-top:8px}summary{cursor:pointer;font-weight:600}\
.wide{overflow-x:auto}table{border-collapse:collapse;margin:8px 0 18px;font-size:13.5px;font-variant-numeric:tabular-nums}\
th,td{padding:2px 10px;text-align:right;border-bottom:1px solid var(--line);vertical-align:top}\
th{font-weight:500;color:var(--muted)}th:first-child,td:first-child{text-align:left;padding-left:0}\
:focus-visible{outline:2px solid var(--accent)}\
@media (max-width:600px){main{padding:10px 12px 40px}.answer{font-size:18px}figure{overflow-x:auto}figure svg{min-width:560px}}\
@page{size:A4;margin:13mm}\
@media print{:root{--panel:#fff;--text:#000;--muted:#333;--line:#ccc;--good:#1d7a4f;--bad:#b3261e;--c0:#2f6fcb;--c1:#d96a26;\
--c2:#2a8f63;--c3:#b83a5e;--c8:#555d66;--c9:#111}\
body{font-size:9.5pt;line-height:1.3}header{padding:0 0 4px}main{padding:0}h2{margin:8px 0 2px;font-size:11pt}.answer{font-size:12pt}\
details,.screen,li:nth-child(n+5),tr:nth-child(n+10){display:none}li{max-height:2.6em;overflow:hidden}section{break-inside:avoid}\
figure{margin:2px 0}.forces svg{max-height:92mm}.friction svg{max-height:42mm}td,th{padding:0 8px}table{font-size:8.5pt;margin:2px 0}p{margin:2px 0}}";
