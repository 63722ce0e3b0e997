//! A player for the motion: a picture, its controls, and the viewer that draws it in space.
//!
//! The viewer is a script for WebGL, bundled from the modules in `viewer/src` with three.js by `npm ci && npm run build`
//! in `viewer/`; the bundle is part of the page, which needs nothing from elsewhere.

use crate::page::html::{PLAYER, data, page, text};
use crate::scene::Scene;

/// The viewer, with the licence of three.js at its head.
pub const VIEWER: &str = include_str!("../../viewer/dist/viewer.js");

/// The controls, whose words the viewer replaces by pictures, and fills where they are empty.
const CONTROLS: &str = r#"<div class="controls" role="group" aria-label="Controls of the motion">
<div class="time"><button type="button" class="play" data-action="play">Play</button>
<input type="range" min="0" max="0" value="0" step="1" aria-label="Time"/>
<output aria-live="off"></output></div>
<div><button type="button" data-action="back">Step back</button><button type="button" data-action="ahead">Step ahead</button><button type="button" data-action="loop">Repeat</button></div>
<label><span>Speed</span> <select data-list="speed"></select></label>
<label><span>Follow</span> <select data-list="follow"></select></label>
<div class="views"><button type="button" data-action="trails">Trails</button><button type="button" data-action="front">Front</button><button type="button" data-action="side">Side</button><button type="button" data-action="top">Top</button><button type="button" data-action="fit">Fit</button><button type="button" data-action="flat">Without perspective</button><button type="button" data-action="full">Full screen</button></div>
</div>
"#;

/// A page that shows only the motion, and plays it at once.
pub fn animation(title: &str, scene: &Scene) -> String {
    let head = format!("<header><h1>{}</h1></header>\n", text(title));
    let body =
        format!("{head}<main class=\"alone\">\n{}</main>\n", written(scene, " data-alone=\"data-alone\""));
    page(title, &body)
}

/// The player as a part of a page, visible only where scripts run and there is WebGL.
pub(crate) fn player(scene: &Scene) -> String {
    written(scene, "")
}

/// The player with further attributes.
fn written(scene: &Scene, attributes: &str) -> String {
    format!(
        "<div class=\"player\" id=\"player\" hidden=\"hidden\"{attributes}>\n\
         <div class=\"stage\"><canvas tabindex=\"0\" role=\"img\" aria-label=\"The motion, drawn. Arrow keys turn the view, \
         plus and minus change its size, F fits it, the space bar plays and pauses, comma and point go to the still before \
         and after.\"></canvas></div>\n{CONTROLS}</div>\n\
         <p class=\"soft\" id=\"player-excuse\" hidden=\"hidden\">The motion cannot be drawn here: this browser has no WebGL, \
         or does not allow it.</p>\n\
         <noscript><p class=\"soft\">The motion can be watched where scripts are allowed.</p></noscript>\n\
         <script type=\"application/json\" id=\"{PLAYER}\">{}</script>\n\
         <script>/*<![CDATA[*/\n{VIEWER}/*]]>*/</script>\n",
        data(&scene.data())
    )
}
