// The page: loads what it carries, then plays a game or a replay, one picture after the other.

import { byId, tell } from "./elements.js";
import { GamePage } from "./game_page.js";
import { Judge } from "./judge.js";
import { Memory } from "./memory.js";
import { Painter } from "./painter.js";
import { ReplayPage } from "./replay_page.js";
import { Sounds } from "./sounds.js";
import { Stage } from "./stage.js";
import { bytesOf, decode, inflate } from "./unpack.js";
import { World } from "./world.js";

const PICTURES = ["table", "heights", "colors", "covers"];

async function load() {
  const meta = JSON.parse(new TextDecoder().decode(await inflate(bytesOf("data-meta"))));
  const [module, pack, ...decoded] = await Promise.all([
    inflate(bytesOf("data-module")).then((bytes) => WebAssembly.instantiate(bytes, {})),
    inflate(bytesOf("data-arrays")),
    ...PICTURES.map((name) => decode(bytesOf(`data-${name}`))),
  ]);
  const pictures = Object.fromEntries(PICTURES.map((name, index) => [name, decoded[index]]));
  const memory = new Memory(module.instance.exports), world = new World(memory, pack, meta.world);
  const painter = new Painter(memory, meta.look, pictures, pack, meta.world.arrays);
  const sounds = new Sounds(meta.sounds, meta.sounds && (await inflate(bytesOf("data-sounds"))));
  const stage = new Stage(world, painter, sounds, meta, byId("canvas"));
  const makeGame = (kind, where, mode, players = 1) => {
    const judge = new Judge(where, pack, meta.rules[mode], meta.game.layout);
    return new kind(where, judge, meta.game, meta.world.groups, players);
  };
  const page = meta.replay
    ? new ReplayPage(stage, makeGame, meta, new World(memory, pack, meta.world))
    : new GamePage(stage, makeGame, meta);
  return { page, stage, meta, makeGame };
}

load().then((loaded) => {
  window.silverball = loaded; // for tests, and for the curious
  performance.mark("ready");
  tell("");
  byId("bar").hidden = false;
  const frame = (now) => {
    if (!loaded.isStopped) loaded.page.frame(now);
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}).catch((error) => tell(`This page cannot be shown: ${error.message}.\nIt needs a browser of 2023 or later.`));
