// SPDX-License-Identifier: GPL-2.0-or-later
// node page_test.js PAGE.html: uses the page of the sample report as a reader does. jsdom draws nothing, so pictures are
// stand-ins of 8 x 6 pixels, and canvases record what is drawn on them.
"use strict";
const assert = require("assert");
const fs = require("fs");
const { JSDOM, VirtualConsole } = require("jsdom");

let picturesOnTheirWay = 0;
const errors = [];
const virtualConsole = new VirtualConsole();
virtualConsole.on("jsdomError", error => errors.push(error.detail ?? error));

function prepare(window) {
    window.Image = class {
        constructor() {
            this.width = 8;
            this.height = 6;
        }
        set src(url) {
            assert.match(url, /^data:image\/png;base64,[A-Za-z0-9+/]+=*$/);
            picturesOnTheirWay++;
            setTimeout(() => {
                picturesOnTheirWay--;
                this.onload();
            });
        }
    };
    window.HTMLCanvasElement.prototype.getContext = function () {
        const canvas = this;
        canvas.drawn ??= [];
        return {
            drawImage: (...args) => canvas.drawn.push(args),
            strokeRect() {}, fillRect() {}, putImageData() {},
            getImageData: (x, y, width, height) => ({ data: new Uint8ClampedArray(4 * width * height).fill(100) }),
        };
    };
    window.HTMLCanvasElement.prototype.getBoundingClientRect = () => ({ left: 0, top: 0, width: 80, height: 60 });
}

const dom = new JSDOM(fs.readFileSync(process.argv[2], "utf8"), { runScripts: "dangerously", beforeParse: prepare, virtualConsole });
const { document, Event, MouseEvent, WheelEvent, KeyboardEvent } = dom.window;
const nextTurn = () => new Promise(resolve => setTimeout(resolve));
// Until no picture is loading, however slow the machine is: each may ask for others.
async function settle() {
    for (let idle = 0; idle < 3; idle = picturesOnTheirWay === 0 ? idle + 1 : 0)
        await nextTurn();
}
const rows = () => [...document.querySelectorAll("#rows tbody tr")];
const column = name => [...document.querySelectorAll("#rows thead th")].find(th => th.dataset.column === name);
const values = name => rows().map(row => row.cells[column(name).cellIndex].textContent);
const viewers = () => [...document.querySelectorAll(".viewer")];
const canvases = viewer => [...viewer.querySelectorAll("canvas")];
const captions = viewer => [...viewer.querySelectorAll("figcaption")].map(caption => caption.firstChild.textContent.trim());
// Source rectangle of what a canvas shows.
const shownPart = canvas => canvas.drawn.filter(args => args.length === 9).at(-1).slice(1, 5);

async function testTable() {
    assert.strictEqual(rows().length, 8);
    column("RMSE").click();
    const ascending = values("RMSE").map(Number);
    assert.deepStrictEqual(ascending, [...ascending].sort((a, b) => a - b));
    assert.strictEqual(column("RMSE").getAttribute("aria-sort"), "ascending");
    column("RMSE").click();
    assert.deepStrictEqual(values("RMSE").map(Number), [...ascending].reverse());
    column("subset").dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
    assert.deepStrictEqual(values("subset"), ["8", "8", "8", "8", "64", "64", "", ""], "numbers, not words; empty ones last");
    column("subset").click();
    assert.deepStrictEqual(values("subset").slice(6), ["", ""]);
    assert.strictEqual(column("RMSE").hasAttribute("aria-sort"), false);

    const filter = document.getElementById("filter");
    filter.value = "asvgf";
    filter.dispatchEvent(new Event("input"));
    assert.strictEqual(rows().filter(row => !row.hidden).length, 2);
    assert.strictEqual(document.getElementById("row-count").textContent, "2 of 8");
    filter.value = "";
    filter.dispatchEvent(new Event("input"));
    assert.strictEqual(rows().filter(row => !row.hidden).length, 8);
}

async function testWindows() {
    assert.strictEqual(viewers().length, 2);
    const [first, second] = viewers();
    assert.deepStrictEqual(captions(first), ["subset R8 blue", "subset R64 blue", "uniform blue", "reference"]);
    assert.deepStrictEqual(canvases(first).map(shownPart), Array(4).fill([0, 0, 8, 6]));

    // Twice as large around a quarter of the picture, in all pictures of this window at once.
    const wheel = new WheelEvent("wheel", { deltaY: -Math.log(2) / 0.002, clientX: 20, clientY: 15, bubbles: true, cancelable: true });
    canvases(first)[1].dispatchEvent(wheel);
    assert.ok(wheel.defaultPrevented, "the page must not scroll");
    for (const canvas of canvases(first))
        shownPart(canvas).forEach((value, i) => assert.ok(Math.abs(value - [1, 0.75, 4, 3][i]) < 1e-6, shownPart(canvas)));
    assert.deepStrictEqual(shownPart(canvases(second)[0]), [0, 0, 8, 6], "another window stays");

    // Dragged by half a picture to the left: stops at the edge.
    const pointer = (type, x, y, buttons = 1) =>
        canvases(first)[0].dispatchEvent(new MouseEvent(type, { clientX: x, clientY: y, buttons, bubbles: true }));
    pointer("pointerdown", 60, 30);
    pointer("pointermove", -500, 30);
    pointer("pointerup", -500, 30, 0);
    for (const canvas of canvases(first))
        assert.ok(Math.abs(shownPart(canvas)[0] - 4) < 1e-6, shownPart(canvas));

    // The pointer's place is magnified in all of them.
    const before = canvases(first).map(canvas => canvas.drawn.length);
    pointer("pointermove", 40, 30, 0);
    canvases(first).forEach((canvas, i) => assert.strictEqual(canvas.drawn.length, before[i] + 2, "picture and inset"));

    first.querySelector(".grid-of-pictures").dispatchEvent(new KeyboardEvent("keydown", { key: "0", bubbles: true }));
    assert.deepStrictEqual(shownPart(canvases(first)[0]), [0, 0, 8, 6]);
}

async function testChoice() {
    const [first, second] = viewers();
    const box = label => [...document.querySelectorAll("#rows input[type=checkbox]")]
        .find(input => input.dataset.picture === label);
    assert.ok(box("0:subset R8 blue").checked);
    assert.ok(!box("0:subset R8 blue asvgf").checked);
    box("0:subset R8 blue asvgf").click();
    box("0:uniform blue").click();
    await settle();
    assert.deepStrictEqual(captions(first), ["subset R8 blue", "subset R64 blue", "subset R8 blue asvgf", "reference"]);
    assert.strictEqual(captions(second).length, 4);
    const difference = first.querySelector(".difference");
    difference.click();
    await settle();
    assert.strictEqual(canvases(first).length, 4);
    assert.ok(canvases(first)[0].drawn.at(-1)[0] instanceof dom.window.HTMLCanvasElement, "a difference is shown");
}

async function main() {
    await settle();
    assert.strictEqual(document.documentElement.dataset.ready, "yes");
    assert.ok(document.body.textContent.includes('b "</script><b>".rtrace'), "names are text");
    assert.ok(document.querySelectorAll("svg.plot").length >= 6);
    await testTable();
    await testWindows();
    await testChoice();
    assert.deepStrictEqual(errors, []);
}

main().catch(error => {
    console.error(error);
    process.exit(1);
});
