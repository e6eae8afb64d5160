(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Doubles as fractions. Every finite double is a whole number over a power of two, so that the numbers of a certificate
   get one denominator, with which the checkers add and compare without multiplying. *)
open Checker

exception Malformed

(* x = whole * 2^-bits, whole odd or 0 *)
let split x =
  let b = Int64.bits_of_float x in
  let exponent = Int64.to_int (Int64.shift_right_logical b 52) land 0x7FF and fraction = Int64.to_int b land 0xFFFFFFFFFFFFF in
  if exponent = 0x7FF then raise Malformed;
  if exponent lor fraction = 0 then (0, 0) else begin
    let w = ref (if exponent = 0 then fraction else fraction lor (1 lsl 52)) and b = ref (1075 - max 1 exponent) in
    while !w land 0xFF = 0 do w := !w lsr 8; b := !b - 8 done;
    while !w land 1 = 0 do w := !w lsr 1; decr b done;
    ((if x < 0. then - !w else !w), !b)
  end

let bits_of x = snd (split x)

(* The fractions of doubles that need at most so many bits behind the point. *)
let over bits =
  let qden = Whole.shift_left Whole.one bits in
  fun x -> let w, b = split x in { qnum = Whole.shift_left (Whole.of_int w) (bits - b); qden }

let fractions xs = over (List.fold_left (fun m x -> let b = bits_of x in if b > m then b else m) 0 xs)
let rational x = fractions [x] x
let to_q a = Q.make a.qnum a.qden
let of_q a = { qnum = Q.num a; qden = Q.den a }

(* a - b, nearly *)
let difference (a : q) (b : q) =
  let num, den = if a.qden == b.qden then (Whole.sub a.qnum b.qnum, a.qden)
    else (Whole.sub (Whole.mul a.qnum b.qden) (Whole.mul b.qnum a.qden), Whole.mul a.qden b.qden) in
  if Whole.numbits den < 1000 then Whole.to_float num /. Whole.to_float den else Q.to_float (Q.make num den)
