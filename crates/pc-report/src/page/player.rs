//! A player for the motion: a canvas, a few controls, and the script that draws.

use pc_print::visible_json;

use crate::page::html::{Part, page, text};
use crate::scene::Scene;

/// A page that shows only the motion.
pub fn animation(title: &str, scene: &Scene) -> String {
    let body = Part::new("animation", "Motion", player(scene)).section();
    page(title, &format!("<header><h1>{}</h1></header>\n<main>\n{body}</main>\n", text(title)))
}

/// The player, which is visible only where scripts run.
pub(crate) fn player(scene: &Scene) -> String {
    // JSON escaped in this way contains neither `</script>` nor the end of a CDATA section.
    let data =
        visible_json(&scene.data()).replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026");
    format!(
        "<div class=\"player\" id=\"player\" hidden=\"hidden\">\n\
         <canvas tabindex=\"0\" role=\"img\" aria-label=\"The motion, drawn. Arrow keys turn the view, plus and minus change its \
         size, the space bar plays and pauses.\"></canvas>\n\
         <div class=\"controls\"><button type=\"button\">Play</button>\n\
         <label class=\"time\">Time <input type=\"range\" min=\"0\" max=\"0\" value=\"0\" step=\"1\"/></label>\n\
         <label>Speed <select><option value=\"0.1\">1/10</option><option value=\"0.25\">1/4</option>\
         <option value=\"0.5\">1/2</option><option value=\"1\" selected=\"selected\">1</option><option value=\"2\">2</option>\
         <option value=\"5\">5</option><option value=\"20\">20</option></select></label>\n\
         <output></output></div>\n</div>\n\
         <noscript><p class=\"soft\">The motion can be watched where scripts are allowed.</p></noscript>\n\
         <script type=\"application/json\" id=\"player-data\">{data}</script>\n\
         <script>/*<![CDATA[*/\n{}/*]]>*/</script>\n",
        include_str!("player.js")
    )
}
