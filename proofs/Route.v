(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Routes of a disc, chains that it cannot pass, and ends without room. *)
Require Import Reals QArith Qreals List Bool Lra Psatz.
From ExactVO Require Import Theorems Plane Parity.
Import ListNotations.
Open Scope R_scope.

(* --- Routes: no piece is nearer to an edge than the radius, and the first point is in no polygon --- *)
Definition is_outside (o : obstacle) (es : list edge) (x : point) : bool :=
  match o with Wall _ => true | Solid _ => negb (qodd es x) end.
Definition route (os : list obstacle) (r : Q) (ps : list point) : bool :=
  match ps with
  | a :: _ :: _ => let boxed := fun e => (outer_of (Qden r) e, e) in let pieces := map boxed (sides ps) in
      qlt 0 r && forallb (fun o => let es := edges_of o in
        is_outside o es a && forallb (fun e => let b := outer_of (Qden r) e in
          forallb (fun piece => outers_apart (Qnum r) (fst piece) b || segments_apart r (snd piece) e) pieces) es) os
  | _ => false
  end.

Definition clear (r : R) (es : list edge) (piece : edge) := forall e x y, In e es -> on piece x -> on e y -> apart r x y.

Lemma apart_off r es x : 0 < r -> (forall e y, In e es -> on e y -> apart r x y) -> off es x.
Proof. intros r0 h e he ox. specialize (h e x he ox). unfold apart, dot, sub in h; simpl in h. nra. Qed.

(* No piece leads into a polygon. *)
Lemma piece_even r es a b : closed es -> 0 < r -> clear r es (a, b) -> odd es (real a) = false ->
  forall x, on (a, b) x -> odd es x = false.
Proof.
  intros c r0 h ha x hx. assert (k : odd es (mix 0 (real a) x) = odd es (mix 1 (real a) x)); [|now rewrite mix_0, mix_1, ha in k].
  apply (odd_path es (fun t => mix t (real a) x) c (mix_continuous _ _)). intros t ht. apply (apart_off r); [assumption|].
  intros e y he hy. apply (h e); [assumption| |assumption]. apply chord; [apply (on_first (a, b))|assumption|assumption].
Qed.

Lemma pieces_even r es rest : closed es -> 0 < r -> forall a, (forall piece, In piece (sides_from a rest) -> clear r es piece) ->
  odd es (real a) = false -> forall piece x, In piece (sides_from a rest) -> on piece x -> odd es x = false.
Proof.
  intros c r0. induction rest as [|b t ih]; intros a h ha piece x hp hx; [destruct hp|]. simpl in *.
  assert (first := piece_even r es a b c r0 (h _ (or_introl eq_refl)) ha).
  destruct hp as [e|hp]; [subst; now apply first|]. apply (ih b) with piece; auto. apply first, (on_second (a, b)).
Qed.

Lemma is_outside_ok o x : is_outside o (edges_of o) x = true ->
  match o with Wall _ => True | Solid _ => odd (edges_of o) (real x) = false end.
Proof. unfold is_outside. destruct o; [auto|]. rewrite qodd_ok. intro h. now apply negb_true_iff in h. Qed.

Theorem route_sound os r ps : route os r ps = true -> forall e x, In e (sides ps) -> on e x -> room os (Q2R r) x.
Proof.
  unfold route. intro h. destruct ps as [|a [|b t]]; try discriminate. set (ps := a :: b :: t) in *.
  apply andb_true_iff in h; destruct h as [r0 h]. apply qlt_R in r0. rewrite Q2R_0 in r0. rewrite forallb_forall in h.
  intros piece x hp hx.
  assert (k : forall o, In o os -> forall piece, In piece (sides ps) -> clear (Q2R r) (edges_of o) piece).
  { intros o ho q hq e u v he hu hv. specialize (h o ho). apply andb_true_iff in h; destruct h as [_ h]. rewrite forallb_forall in h.
    specialize (h e he). cbv zeta in h. rewrite forallb_forall in h.
    specialize (h _ (in_map (fun e => (outer_of (Qden r) e, e)) _ _ hq)). apply orb_true_iff in h. cbn [fst snd] in h. destruct h as [h|h].
    - apply (outers_apart_ok r _ _ u v) in h; [assumption|lra|now apply outer_of_ok|now apply outer_of_ok].
    - apply segments_apart_ok in h. destruct h as [_ h]. now apply h. }
  split; [|intros o e y ho he hy; now apply (k o ho piece hp e)].
  intros o ho. specialize (h o ho). apply andb_true_iff in h; destruct h as [out _]. apply is_outside_ok in out. destruct o as [l|rs]; [exact I|].
  apply (pieces_even (Q2R r) _ (b :: t) (rings_closed rs) r0 a (k _ ho) out piece); assumption.
Qed.

Lemma route_here os r x : route os r [x; x] = true -> room os (Q2R r) (real x).
Proof. intro h. apply (route_sound _ _ _ h (x, x)); [now left|apply (on_first (x, x))]. Qed.

(* --- Points on edges --- *)
Definition on_edge (e : edge) (x : point) : bool :=
  let d := psub (snd e) (fst e) in let w := psub x (fst e) in
  let dd := pdot d d in let dw := pdot d w in
  qeq (pcross d w) 0 && qle 0 dw && qle dw dd && (qlt 0 dd || peq x (fst e)).

Lemma on_edge_sound e x : on_edge e x = true -> on e (real x).
Proof.
  unfold on_edge. intro h. apply andb_true_iff in h; destruct h as [h z]. reals.
  set (d := sub (real (snd e)) (real (fst e))) in *. set (w := sub (real x) (real (fst e))) in *.
  destruct e as [a b]; simpl in *. apply on_mix. apply orb_true_iff in z. destruct z as [z|z].
  - reals. fold d in z. exists (dot d w / dot d d). split; [apply share_bounds; lra|].
    assert (k1 : fst w * dot d d = dot d w * fst d - snd d * cross d w) by (unfold dot, cross; ring).
    assert (k2 : snd w * dot d d = dot d w * snd d + fst d * cross d w) by (unfold dot, cross; ring).
    rewrite H in k1, k2.
    assert (f1 : fst w = dot d w / dot d d * fst d) by (apply Rmult_eq_reg_r with (dot d d); [rewrite k1; field; lra|lra]).
    assert (f2 : snd w = dot d w / dot d d * snd d) by (apply Rmult_eq_reg_r with (dot d d); [rewrite k2; field; lra|lra]).
    revert f1 f2. generalize (dot d w / dot d d). intros s f1 f2. unfold w, d, sub, real in f1, f2; simpl in f1, f2.
    unfold mix, add, scale, real; simpl. f_equal; lra.
  - apply peq_real in z. exists 0. split; [lra|]. now rewrite mix_0.
Qed.

(* --- Chains: each side runs along an edge, or is shorter than two radii --- *)
Definition lookup (table : list (list edge)) (j : joint) : option edge :=
  match nth_error table (obstacle_no j) with Some es => nth_error es (edge_no j) | None => None end.
Definition linked (table : list (list edge)) (r : Q) (j : joint) (to : point) : bool :=
  match lookup table j with
  | None => false
  | Some e => on_edge e (spot j) &&
      if gap_follows j then let d := psub to (spot j) in qlt (pdot d d) (qmul 4 (qmul r r)) else on_edge e to
  end.
Fixpoint all_linked (table : list (list edge)) (r : Q) (first : point) (a : joint) (rest : list joint) : bool :=
  match rest with
  | [] => linked table r a first
  | b :: t => linked table r a (spot b) && all_linked table r first b t
  end.
Definition chain (os : list obstacle) (r : Q) (s g : point) (js : list joint) : bool :=
  match js with
  | a :: (_ :: _) as rest => let ring := ring_sides (map spot js) in
      all_linked (map edges_of os) r (spot a) a (tl js)
      && xorb (qodd ring s) (qodd ring g) && route os r [s; s] && route os r [g; g]
  | _ => false
  end.

Definition covered (table : list (list edge)) (x : vec) := exists es e, In es table /\ In e es /\ on e x.

Lemma lookup_covered table j e x : lookup table j = Some e -> on e x -> covered table x.
Proof.
  unfold lookup. destruct (nth_error table (obstacle_no j)) as [es|] eqn:h; [|discriminate]. intros k hx.
  exists es, e. split; [now apply nth_error_In with (1 := h)|]. split; [now apply nth_error_In with (1 := k)|assumption].
Qed.
Lemma linked_covered table r j q : linked table r j q = true -> covered table (real (spot j)).
Proof.
  unfold linked. destruct (lookup table j) as [e|] eqn:h; [|discriminate]. intro k. apply andb_true_iff in k. destruct k as [k _].
  apply on_edge_sound in k. now apply lookup_covered with (1 := h).
Qed.

Lemma gap_near a b x r : 0 < r -> on (a, b) x -> dot (sub (real b) (real a)) (sub (real b) (real a)) < 4 * (r * r) ->
  ~ apart r x (real a) \/ ~ apart r x (real b).
Proof.
  intros r0 h l. apply on_mix in h. destruct h as [s [hs e]]. subst x. unfold apart.
  set (k := dot (sub (real b) (real a)) (sub (real b) (real a))) in *. assert (0 <= k) by apply dot_self.
  assert (ea : dot (sub (mix s (real a) (real b)) (real a)) (sub (mix s (real a) (real b)) (real a)) = s * s * k)
    by (unfold k, dot, sub, mix, add, scale; simpl; ring).
  assert (eb : dot (sub (mix s (real a) (real b)) (real b)) (sub (mix s (real a) (real b)) (real b)) = (1 - s) * (1 - s) * k)
    by (unfold k, dot, sub, mix, add, scale; simpl; ring).
  rewrite ea, eb. assert (q : forall u, 0 <= u <= 1 / 2 -> u * u * k < r * r) by (intros u hu; assert (u * u <= 1 / 4) by nra; nra).
  destruct (Rle_or_lt s (1 / 2)); [left|right]; apply Rlt_not_le, q; lra.
Qed.

(* Where no covered point is nearer than the radius, no side of the chain is. *)
Definition free (table : list (list edge)) (r : R) (x : vec) := forall y, covered table y -> apart r x y.

Lemma link_off table r j q x : 0 < Q2R r -> free table (Q2R r) x -> linked table r j q = true -> covered table (real q) ->
  ~ on (spot j, q) x.
Proof.
  intros r0 fr h cq ox. pose proof (linked_covered _ _ _ _ h) as cj. unfold linked in h.
  destruct (lookup table j) as [e|] eqn:l; [|discriminate]. apply andb_true_iff in h. destruct h as [hj h].
  destruct (gap_follows j).
  - reals. destruct (gap_near _ _ _ _ r0 ox h) as [n|n]; apply n, fr; assumption.
  - apply on_edge_sound in hj, h. assert (on e x).
    { apply hull_convex with (2 := ox). intros p [p1|[p1|[]]]; subst; assumption. }
    assert (k : apart (Q2R r) x x) by (apply fr; now apply lookup_covered with (1 := l)).
    unfold apart, dot, sub in k; simpl in k. nra.
Qed.

Lemma links_off table r first x rest : 0 < Q2R r -> free table (Q2R r) x -> covered table (real first) ->
  forall a, all_linked table r first a rest = true -> off (sides_from (spot a) (map spot rest ++ [first])) x.
Proof.
  intros r0 fr cf. induction rest as [|b t ih]; intros a h e he; simpl in *.
  - destruct he as [he|[]]; subst. now apply (link_off table r).
  - apply andb_true_iff in h. destruct h as [h ht]. destruct he as [he|he]; [subst|now apply (ih b)].
    apply (link_off table r); auto. destruct t; simpl in ht; [|apply andb_true_iff in ht; destruct ht as [ht _]]; now apply linked_covered with (1 := ht).
Qed.

Theorem chain_sound os r s g js : chain os r s g js = true ->
  room os (Q2R r) (real s) /\ room os (Q2R r) (real g) /\ ~ way os (Q2R r) (real s) (real g).
Proof.
  unfold chain. intro h. destruct js as [|a [|b t]]; try discriminate.
  apply andb_true_iff in h; destruct h as [h rg]. apply andb_true_iff in h; destruct h as [h rs]. apply andb_true_iff in h; destruct h as [links x].
  assert (r0 : 0 < Q2R r) by (unfold route in rs; apply andb_true_iff in rs; destruct rs as [q _]; apply qlt_R in q; now rewrite Q2R_0 in q).
  split; [now apply route_here|]. split; [now apply route_here|]. intros [p [c [ps [pg fr]]]].
  rewrite !qodd_ok, <- ps, <- pg in x. rewrite (odd_path _ p (ring_closed _) c) in x; [now rewrite xorb_nilpotent in x|].
  intros t' ht. change (off (sides_from (spot a) (map spot (b :: t) ++ [spot a])) (p t')).
  apply (links_off (map edges_of os) r); [assumption| | |exact links].
  - intros y [es [e [hes [he hy]]]]. apply in_map_iff in hes. destruct hes as [o [eo ho]]. subst es.
    destruct (fr t' ht) as [_ k]. now apply (k o e).
  - simpl in links. apply andb_true_iff in links. destruct links as [l _]. now apply linked_covered with (1 := l).
Qed.

(* --- Ends without room --- *)
Definition nearer (r : Q) (x : point) (e : edge) : bool :=
  let d := psub (snd e) (fst e) in let w := psub x (fst e) in let u := psub x (snd e) in
  let dd := pdot d d in let dw := pdot d w in let rr := qmul r r in
  qlt (pdot w w) rr || qlt (pdot u u) rr ||
  (qlt 0 dd && qle 0 dw && qle dw dd && (let k := pcross d w in qlt (qmul k k) (qmul rr dd))).
Definition blocked (os : list obstacle) (r : Q) (x : point) (o : nat) (e : option nat) : bool :=
  qle 0 r && match nth_error os o with
  | None => false
  | Some o => match e with
    | Some k => match nth_error (edges_of o) k with Some e => nearer r x e | None => false end
    | None => match o with Wall _ => false | Solid _ =>
        let es := edges_of o in qodd es x && forallb (fun e => negb (on_edge e x)) es end
    end
  end.

Lemma nearer_ok r x e : nearer r x e = true -> exists y, on e y /\ ~ apart (Q2R r) (real x) y.
Proof.
  unfold nearer. intro h. rewrite !orb_true_iff in h. destruct h as [[h|h]|h].
  - exists (real (fst e)). split; [apply on_first|]. reals. unfold apart. lra.
  - exists (real (snd e)). split; [apply on_second|]. reals. unfold apart. lra.
  - destruct e as [a b]. simpl in *. reals. set (d := sub (real b) (real a)) in *. set (w := sub (real x) (real a)) in *.
    exists (mix (dot d w / dot d d) (real a) (real b)). split; [apply on_mix; eexists; split; [|reflexivity]; apply share_bounds; lra|].
    unfold apart. apply Rlt_not_le. apply Rmult_lt_reg_r with (dot d d); [assumption|]. apply Rle_lt_trans with (2 := H0). right.
    set (q := dot d w / dot d d). assert (eq : dot d w = q * dot d d) by (unfold q; field; lra).
    replace (sub (real x) (mix q (real a) (real b))) with (sub w (scale q d)) by (unfold w, d, sub, mix, add, scale; simpl; f_equal; ring).
    replace (dot (sub w (scale q d)) (sub w (scale q d)) * dot d d) with (dot w w * dot d d - 2 * q * dot d w * dot d d + q * q * dot d d * dot d d)
      by (unfold dot, sub, scale; simpl; ring).
    replace (cross d w * cross d w) with (dot w w * dot d d - dot d w * dot d w) by (unfold cross, dot; ring). rewrite eq. ring.
Qed.

Theorem blocked_sound os r x o e : blocked os r x o e = true -> ~ room os (Q2R r) (real x).
Proof.
  unfold blocked. intros h [k2 k1]. apply andb_true_iff in h; destruct h as [_ h]. destruct (nth_error os o) as [ob|] eqn:ho; [|discriminate]. apply nth_error_In in ho.
  destruct e as [i|].
  - destruct (nth_error (edges_of ob) i) as [e|] eqn:he; [|discriminate]. apply nth_error_In in he.
    apply nearer_ok in h. destruct h as [y [hy n]]. apply n. now apply (k1 ob e).
  - specialize (k2 ob ho). destruct ob; [discriminate|]. apply andb_true_iff in h. destruct h as [h _]. rewrite qodd_ok in h. congruence.
Qed.
