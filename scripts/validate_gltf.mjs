#!/usr/bin/env node
// SPDX-License-Identifier: MIT
// Runs the Khronos glTF validator over files:  validate_gltf.mjs [--modules FOLDER] FILE...
// The npm package gltf-validator is looked for in FOLDER/node_modules, then in NODE_PATH.
// Prints every issue; status 1 when a file has an error, a warning or a hint that is not listed
// below, 2 when the validator or a file is missing.

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { delimiter, dirname, join, resolve } from 'node:path';
import process from 'node:process';

// Issues that are meant to be there, each with its reason. Pieces of information never fail.
const EXPECTED = new Map([]);

const SEVERITIES = ['error', 'warning', 'hint', 'information'];
const INFORMATION = 3;

function parseArguments(words) {
  const folders = (process.env.NODE_PATH ?? '').split(delimiter).filter(Boolean);
  const files = [];
  while (words.length > 0) {
    const word = words.shift();
    if (word === '--modules' && words.length > 0) {
      folders.unshift(join(words.shift(), 'node_modules'));
    } else {
      files.push(word);
    }
  }
  return { folders, files };
}

function loadValidator(folders) {
  const require = createRequire(import.meta.url);
  const candidates = folders.map((folder) => resolve(folder, 'gltf-validator'));
  for (const candidate of [...candidates, 'gltf-validator']) {
    try {
      return require(candidate);
    } catch (error) {
      if (error.code !== 'MODULE_NOT_FOUND') {
        throw error;
      }
    }
  }
  return null;
}

// Resolves to the number of issues that count against the file.
async function validate(validator, file) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
    uri: file,
    maxIssues: 1000,
    externalResourceFunction: async (uri) =>
      new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri)))),
  });
  let faults = 0;
  for (const issue of report.issues.messages) {
    const reason = EXPECTED.get(issue.code);
    const counts = issue.severity < INFORMATION && reason === undefined;
    faults += counts ? 1 : 0;
    const note = reason === undefined ? '' : ` (expected: ${reason})`;
    const where = issue.pointer ?? (issue.offset === undefined ? '' : `@ byte ${issue.offset}`);
    console.log(
      `${file}: ${SEVERITIES[issue.severity]}: ${issue.code}: ${where}: ${issue.message}${note}`);
  }
  if (report.issues.truncated) {
    console.log(`${file}: error: more issues than are listed`);
    faults += 1;
  }
  const info = report.info ?? {};
  console.log(`${file}: ${faults === 0 ? 'valid' : 'INVALID'}: ` +
    `${info.totalVertexCount ?? 0} vertices, ${info.totalTriangleCount ?? 0} triangles`);
  return faults;
}

const { folders, files } = parseArguments(process.argv.slice(2));
const validator = loadValidator(folders);
if (validator === null) {
  console.error('validate_gltf: gltf-validator is not installed; npm install gltf-validator ' +
    'and name the folder with --modules');
  process.exitCode = 2;
} else if (files.length === 0) {
  console.error('usage: validate_gltf.mjs [--modules FOLDER] FILE...');
  process.exitCode = 2;
} else {
  let faults = 0;
  for (const file of files) {
    try {
      faults += await validate(validator, file);
    } catch (error) {
      console.error(`validate_gltf: ${file}: ${error.message ?? error}`);
      process.exitCode = 2;
    }
  }
  if (faults > 0) {
    process.exitCode = 1;
  }
}
