// SPDX-License-Identifier: GPL-2.0-or-later
// The page's life: linked windows onto pictures, a table that sorts, filters and chooses pictures.
"use strict";
(() => {
    const data = JSON.parse(document.getElementById("data").textContent);
    const magnification = 6, insetShare = 0.3, mostZoom = 64, differenceGain = 4;

    const images = new Map(); // picture -> loaded Image
    function load(picture) {
        if (!images.has(picture)) {
            const image = new Image();
            images.set(picture, new Promise(resolve => {
                image.onload = () => resolve(image);
                image.src = data.pictures[picture];
            }));
        }
        return images.get(picture);
    }

    function pixelsOf(image) {
        const canvas = document.createElement("canvas");
        canvas.width = image.width;
        canvas.height = image.height;
        const context = canvas.getContext("2d", { willReadFrequently: true });
        context.drawImage(image, 0, 0);
        return { canvas, context, pixels: context.getImageData(0, 0, image.width, image.height) };
    }

    // |picture - reference| as shown, magnified.
    function difference(image, reference) {
        const result = pixelsOf(image), truth = pixelsOf(reference).pixels.data, values = result.pixels.data;
        for (let i = 0; i < values.length; i++)
            if (i % 4 !== 3)
                values[i] = Math.min(255, differenceGain * Math.abs(values[i] - truth[i]));
        result.context.putImageData(result.pixels, 0, 0);
        return result.canvas;
    }

    // Pictures in rows and columns that show the same part of the scene.
    class Viewer {
        constructor(root, figure) {
            this.root = root;
            this.figure = figure;
            this.grid = root.querySelector(".grid-of-pictures");
            this.start = { x: figure.x, y: figure.y, zoom: figure.zoom };
            this.view = { ...this.start };
            this.pointer = null; // where the insets look: shares of the picture
            this.isHeld = false;
            this.showsDifference = false;
            this.listen();
            this.fill();
        }

        async fill() {
            const order = this.order = {};
            const rows = this.figure.rows, columns = Math.max(1, ...rows.map(row => row.length));
            const cells = [];
            for (const row of rows)
                for (const item of row) {
                    const image = await load(item.picture);
                    cells.push({ item, image: this.showsDifference ? difference(image, await load(item.reference)) : image });
                }
            if (this.order !== order)
                return; // filled anew meanwhile
            this.grid.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
            this.grid.replaceChildren(...cells.map(cell => this.makeCell(cell)));
            this.cells = cells;
            this.draw();
        }

        makeCell(cell) {
            const frame = document.createElement("figure"), caption = document.createElement("figcaption");
            cell.canvas = document.createElement("canvas");
            caption.append(cell.item.caption + " ");
            const small = document.createElement("small");
            small.textContent = cell.item.figures;
            caption.append(small);
            frame.append(cell.canvas, caption);
            return frame;
        }

        draw() {
            for (const cell of this.cells ?? [])
                this.drawCell(cell);
        }

        drawCell({ canvas, image }) {
            const scale = window.devicePixelRatio || 1, width = Math.max(1, Math.round((canvas.clientWidth || image.width) * scale));
            canvas.width = width;
            canvas.height = Math.max(1, Math.round(width * image.height / image.width));
            const context = canvas.getContext("2d");
            if (!context)
                return;
            this.drawPart(context, image, this.view, 0, 0, canvas.width, canvas.height);
            if (this.pointer)
                this.drawInset(context, image, canvas);
        }

        // The part of `image` around (x, y), `zoom` times as large as the whole would be.
        drawPart(context, image, { x, y, zoom }, left, top, width, height, wholeWidth = width) {
            const perPixel = wholeWidth / image.width * zoom, w = width / perPixel, h = height / perPixel;
            context.imageSmoothingEnabled = perPixel < 1;
            context.drawImage(image, x * image.width - w / 2, y * image.height - h / 2, w, h, left, top, width, height);
        }

        drawInset(context, image, canvas) {
            const side = Math.round(canvas.width * insetShare), zoom = this.view.zoom * magnification;
            const place = this.toCanvas(canvas, this.pointer), half = side / magnification / 2;
            const left = place.x > canvas.width - side - 2 * half && place.y < side + 2 * half ? 0 : canvas.width - side;
            context.strokeStyle = "#ffd23f";
            context.lineWidth = Math.max(1, window.devicePixelRatio || 1);
            context.strokeRect(place.x - half, place.y - half, 2 * half, 2 * half);
            context.fillStyle = "#000";
            context.fillRect(left, 0, side, side);
            this.drawPart(context, image, { ...this.pointer, zoom }, left, 0, side, side, canvas.width);
            context.strokeRect(left + 0.5, 0.5, side - 1, side - 1);
        }

        toCanvas(canvas, { x, y }) {
            return {
                x: ((x - this.view.x) * this.view.zoom + 0.5) * canvas.width,
                y: ((y - this.view.y) * this.view.zoom + 0.5) * canvas.height,
            };
        }

        // From a mouse event to shares of the picture.
        toPicture(event) {
            const box = event.target.getBoundingClientRect();
            return {
                x: this.view.x + ((event.clientX - box.left) / box.width - 0.5) / this.view.zoom,
                y: this.view.y + ((event.clientY - box.top) / box.height - 0.5) / this.view.zoom,
            };
        }

        keepInside() {
            const reach = 0.5 / this.view.zoom;
            this.view.x = Math.min(Math.max(this.view.x, reach), 1 - reach);
            this.view.y = Math.min(Math.max(this.view.y, reach), 1 - reach);
        }

        zoomBy(factor, at = this.view) {
            const zoom = Math.min(Math.max(this.view.zoom * factor, 1), mostZoom), share = this.view.zoom / zoom;
            this.view = { x: at.x + (this.view.x - at.x) * share, y: at.y + (this.view.y - at.y) * share, zoom };
            this.keepInside();
            this.draw();
        }

        moveBy(x, y) {
            this.view.x += x / this.view.zoom;
            this.view.y += y / this.view.zoom;
            this.keepInside();
            this.draw();
        }

        reset() {
            this.view = { x: 0.5, y: 0.5, zoom: 1 };
            this.isHeld = false;
            this.pointer = null;
            this.draw();
        }

        listen() {
            const onCanvas = handler => event => {
                if (event.target.tagName === "CANVAS")
                    handler(event);
            };
            let drag = null;
            this.grid.addEventListener("wheel", onCanvas(event => {
                event.preventDefault();
                this.zoomBy(Math.exp(-event.deltaY * 0.002), this.toPicture(event));
            }), { passive: false });
            this.grid.addEventListener("pointerdown", onCanvas(event => {
                drag = { x: event.clientX, y: event.clientY, moved: 0 };
            }));
            this.grid.addEventListener("pointermove", onCanvas(event => {
                const box = event.target.getBoundingClientRect();
                if (drag && event.buttons) {
                    const x = event.clientX - drag.x, y = event.clientY - drag.y;
                    drag = { x: event.clientX, y: event.clientY, moved: drag.moved + Math.abs(x) + Math.abs(y) };
                    this.moveBy(-x / box.width, -y / box.height);
                } else if (!this.isHeld) {
                    this.pointer = this.toPicture(event);
                    this.draw();
                }
            }));
            this.grid.addEventListener("pointerup", onCanvas(event => {
                if (drag && drag.moved < 4) {
                    this.isHeld = !this.isHeld;
                    this.pointer = this.toPicture(event);
                    this.draw();
                }
                drag = null;
            }));
            this.grid.addEventListener("pointerleave", () => {
                drag = null;
                if (!this.isHeld) {
                    this.pointer = null;
                    this.draw();
                }
            });
            this.grid.addEventListener("dblclick", () => this.reset());
            const keys = {
                ArrowLeft: () => this.moveBy(-0.1, 0), ArrowRight: () => this.moveBy(0.1, 0),
                ArrowUp: () => this.moveBy(0, -0.1), ArrowDown: () => this.moveBy(0, 0.1),
                "+": () => this.zoomBy(1.25), "=": () => this.zoomBy(1.25), "-": () => this.zoomBy(0.8), 0: () => this.reset(),
            };
            this.grid.addEventListener("keydown", event => {
                if (keys[event.key]) {
                    event.preventDefault();
                    keys[event.key]();
                }
            });
            this.root.querySelector(".difference").addEventListener("change", event => {
                this.showsDifference = event.target.checked;
                this.fill();
            });
            window.addEventListener("resize", () => this.draw());
        }
    }

    const viewers = [...document.querySelectorAll(".viewer")].map(root => new Viewer(root, data.figures[root.dataset.figure]));

    // ---- the table

    const body = document.querySelector("#rows tbody"), rows = [...body.rows];
    const cellValue = (row, column) => row.cells[column].dataset.value ?? row.cells[column].textContent;

    // Empty cells come last, whichever way.
    function compare(a, b, isNumber, sign) {
        if (a === "" || b === "")
            return (a === "") - (b === "");
        return sign * (isNumber ? Number(a) - Number(b) : a.localeCompare(b, "en", { numeric: true }));
    }

    function sortBy(header) {
        const column = header.cellIndex, isDown = header.getAttribute("aria-sort") === "ascending";
        for (const other of header.parentNode.cells)
            other.removeAttribute("aria-sort");
        header.setAttribute("aria-sort", isDown ? "descending" : "ascending");
        const isNumber = !header.classList.contains("word"), sign = isDown ? -1 : 1;
        rows.sort((a, b) => compare(cellValue(a, column), cellValue(b, column), isNumber, sign));
        body.append(...rows);
    }
    for (const header of document.querySelectorAll("#rows thead th[data-column]")) {
        header.tabIndex = 0;
        header.addEventListener("click", () => sortBy(header));
        header.addEventListener("keydown", event => {
            if (event.key === "Enter" || event.key === " ") {
                event.preventDefault();
                sortBy(header);
            }
        });
    }

    function filterRows(text) {
        const words = text.toLowerCase().split(/\s+/).filter(Boolean);
        let shown = 0;
        for (const row of rows) {
            const cells = new Set([...row.cells].map(cell => cell.textContent.trim().toLowerCase()));
            row.hidden = !words.every(word => cells.has(word) || row.cells[1].textContent.toLowerCase().includes(word));
            shown += row.hidden ? 0 : 1;
        }
        document.getElementById("row-count").textContent = `${shown} of ${rows.length}`;
    }
    const filter = document.getElementById("filter");
    filter.addEventListener("input", () => filterRows(filter.value));
    filterRows("");

    // A row's box puts its picture into the scene's free window, before the reference.
    for (const box of document.querySelectorAll("#rows input[type=checkbox]")) {
        const viewer = viewers.find(v => v.figure.free && v.figure.scene === Number(box.dataset.scene));
        const shown = () => viewer.figure.rows[0];
        box.checked = shown().some(item => item.picture === box.dataset.picture);
        box.addEventListener("change", () => {
            const reference = shown().pop();
            if (box.checked)
                shown().push({ ...box.dataset });
            else
                viewer.figure.rows[0] = shown().filter(item => item.picture !== box.dataset.picture);
            shown().push(reference);
            viewer.fill();
        });
    }

    document.documentElement.dataset.ready = "yes";
})();
