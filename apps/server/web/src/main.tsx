import { render } from "preact";
import { App } from "./app";
import { follow_address } from "./router";
import "./styles/tokens.css";
import "./styles/base.css";
import "./styles/controls.css";
import { theme, use_theme } from "./ui/theme";

use_theme(theme());
follow_address();
render(<App />, document.getElementById("app")!);
