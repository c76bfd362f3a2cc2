// Ends a program of Node.js that reaches for the network.
const { writeSync } = require('node:fs');
const { Socket } = require('node:net');

Socket.prototype.connect = () => {
  writeSync(2, 'the program reached for the network\n');
  process.exit(1);
};
